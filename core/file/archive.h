#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

/// Archives that common tools can read, by libarchive. It brings along ICU and a dozen other
/// libraries, which would make the start of the program a third longer. The code that uses it (core/file/libraries/) is
/// therefore a module that is loaded on first use.
namespace terrazzo {

/// Writes an archive under a temporary name, which is removed unless finish() is called. The same content gives the
/// same bytes: times and owners are left out. Throws FileError.
class ArchiveWriter {
 public:
  virtual ~ArchiveWriter() = default;
  virtual void add(const std::string& name, std::string_view bytes) = 0;
  virtual void add_file(const std::string& name, const std::filesystem::path& file) = 0;
  /// Completes the archive and renames it to the target.
  virtual void finish() = 0;
};

/// Goes through the regular files of a tar archive once. Throws Error if it is no archive, is cut off or damaged, or
/// contains anything but regular files and folders.
class ArchiveReader {
 public:
  virtual ~ArchiveReader() = default;
  /// Goes on to the next file; false after the last.
  virtual bool next() = 0;
  virtual const std::string& name() const = 0;
  virtual uint64_t bytes() const = 0;
  /// Reads on in the file: `most` bytes, or fewer at its end.
  virtual size_t read(char* out, size_t most) = 0;
  /// Writes the file's bytes to `target`, whose folder must exist. Throws FileError too.
  virtual void extract(const std::filesystem::path& target) = 0;
};

enum class ArchiveFormat : uint8_t { tar, zip };

std::unique_ptr<ArchiveWriter> write_archive(const std::filesystem::path& target,
                                             ArchiveFormat format = ArchiveFormat::tar);
std::unique_ptr<ArchiveReader> read_archive(const std::filesystem::path& archive);

/// Whether a file begins like a tar archive; false if it cannot be read.
bool is_archive(const std::filesystem::path& file);

/// What the module provides.
struct ArchiveLibrary {
  decltype(write_archive)* write;
  decltype(read_archive)* read;
};

}  // namespace terrazzo
