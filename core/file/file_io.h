#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "core/base/error.h"
#include "core/base/hash.h"

namespace terrazzo {

/// An operating system error: no such file, no permission, no space. code() is errno.
class FileError : public Error {
 public:
  FileError(const std::string& message, int code) : Error(message), code_(code) {}
  int code() const { return code_; }

 private:
  int code_;
};

/// An open file descriptor, closed by the destructor.
class File {
 public:
  File() = default;
  explicit File(int descriptor) : descriptor_(descriptor) {}
  File(File&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}
  File& operator=(File&& other) noexcept {
    std::swap(descriptor_, other.descriptor_);
    return *this;
  }
  ~File();

  /// Opens with the flags of open(2), close-on-exec added. Not ok() on failure, with errno set.
  static File open(const std::filesystem::path& path, int flags);

  bool ok() const { return descriptor_ >= 0; }
  int descriptor() const { return descriptor_; }
  /// In bytes. Throws FileError naming `path`.
  uint64_t size(const std::filesystem::path& path) const;
  /// Reads up to `size` bytes from `offset`, fewer only at the end of the file. Throws FileError naming `path`.
  /// Thread-safe.
  size_t read_at(uint64_t offset, void* out, size_t size, const std::filesystem::path& path) const;
  /// Writes all bytes at `offset`. Throws FileError naming `path`.
  void write_at(uint64_t offset, const void* data, size_t size, const std::filesystem::path& path) const;
  /// Throws FileError naming `path`: some file systems report a lack of space only now.
  void close(const std::filesystem::path& path);
  /// Waits until the content is on disk, then closes. Throws FileError naming `path`.
  void sync_and_close(const std::filesystem::path& path);

 private:
  int descriptor_ = -1;
};

/// Opens a regular file for reading. Throws FileError naming `path`, also for pipes and devices, which could block or
/// be endless.
File open_to_read(const std::filesystem::path& path);

/// The content of a regular file. Throws FileError naming `path`, also if it is longer than `most` bytes.
std::string read_file(const std::filesystem::path& path, uint64_t most = UINT64_MAX);

/// Describes a file type: "a folder", "a pipe", "a device"; empty for regular and missing files.
std::string irregular_kind(std::filesystem::file_type type);

/// Creates the file or overwrites it in place; it may be a device or a pipe. If `sync`, waits until the content is on
/// disk. Throws FileError naming `path`.
void write_file(const std::filesystem::path& path, std::string_view bytes, bool sync = false);

/// The digest of a file's content; empty if it cannot be read. In the first form `path` is only for messages.
std::optional<Digest> content_digest(const File& file, const std::filesystem::path& path);
std::optional<Digest> content_digest(const std::filesystem::path& path);

/// The operating system's message for an error number ("No space left on device").
std::string system_message(int code);

/// Throws FileError "cannot <verb> <path>: <what the system says>".
[[noreturn]] void throw_system_error(std::string_view verb, const std::filesystem::path& path, int code);

}  // namespace terrazzo
