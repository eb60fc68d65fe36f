#pragma once

#include <filesystem>
#include <string>
#include <string_view>

/// Atomic file writes: under a temporary name beside the target, then renamed. Thread-safe.
namespace terrazzo {

/// Why the file `name` cannot be written into `folder` (which need not exist yet), as a sentence; empty if it can. An
/// empty name checks the folder only. Tries to write, and leaves nothing behind.
std::string why_not_writable(const std::filesystem::path& folder, const std::string& name);

/// A unique name beside `target` with the target's extension, by which image libraries choose the format.
std::filesystem::path temporary_beside(const std::filesystem::path& target);

/// Renames a finished file to `target`. If `sync`, waits until the new name is on disk. On failure removes `temporary`
/// and throws FileError naming `target`.
void publish_file(const std::filesystem::path& temporary, const std::filesystem::path& target, bool sync = false);

/// Writes all bytes or nothing: into `temporary`, in the same folder, which is then renamed. If `sync`, waits until
/// they are on disk. On failure removes `temporary` and throws FileError naming `target`.
void write_whole_file(const std::filesystem::path& target, std::string_view bytes,
                      const std::filesystem::path& temporary, bool sync = false);
/// The same with a name from `temporary_beside`. Creates the folder if necessary. Follows links. An existing file keeps
/// its mode and, if permitted, its owner. Devices and pipes are written in place.
void write_whole_file(const std::filesystem::path& target, std::string_view bytes);

/// Removes temporary files (names of `temporary_beside`) of killed processes: those of dead processes on this host, and
/// those of other hosts that have not been written to for a day. Ignores errors.
void remove_abandoned(const std::filesystem::path& folder);

}  // namespace terrazzo
