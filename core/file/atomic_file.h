#pragma once

#include <filesystem>
#include <string>
#include <string_view>

/// Files on their way to their place: written under a temporary name beside the target, then renamed.
namespace terrazzo {

/// Why `name` could not be written into `folder` (which need not exist yet), as a sentence; empty if nothing speaks
/// against it. An empty name stands for one that is not known yet. Tries it out, and leaves nothing behind.
std::string why_not_writable(const std::filesystem::path& folder, const std::string& name);

/// A name beside `target` that nobody else uses, with the target's extension: image libraries choose the format by it.
std::filesystem::path temporary_beside(const std::filesystem::path& target);

/// Renames a finished file to its place. If `sync`, its new name is on the disk afterwards. Throws FileError naming
/// `target`; then `temporary` is gone.
void publish_file(const std::filesystem::path& temporary, const std::filesystem::path& target, bool sync = false);

/// Writes all of the bytes or nothing: into `temporary`, in the same folder, which is then renamed. If `sync`, they are
/// on the disk afterwards. Throws FileError naming `target`; then `temporary` is gone.
void write_whole_file(const std::filesystem::path& target, std::string_view bytes,
                      const std::filesystem::path& temporary, bool sync = false);
/// The same under a name of `temporary_beside`, in a folder that is made if it is missing. Links are followed; a file
/// that is there keeps its mode and, where that is allowed, its owner. A device or a pipe is written in place.
void write_whole_file(const std::filesystem::path& target, std::string_view bytes);

/// Removes what processes that were killed have left under names of `temporary_beside`: files of processes of this
/// host that no longer run, and of others if nothing has been written to them for a day. What cannot be removed stays.
void remove_abandoned(const std::filesystem::path& folder);

}  // namespace terrazzo
