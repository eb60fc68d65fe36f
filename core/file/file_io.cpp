#include "core/file/file_io.h"

#include <array>
#include <cerrno>
#include <system_error>
#include <vector>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

namespace terrazzo {

File::~File() {
  if (ok()) ::close(descriptor_);
}

File File::open(const std::filesystem::path& path, int flags) {
  int descriptor = -1;
  do descriptor = ::open(path.c_str(), flags | O_CLOEXEC, 0666);
  while (descriptor < 0 && errno == EINTR);
  return File(descriptor);
}

uint64_t File::size(const std::filesystem::path& path) const {
  struct stat status;
  if (::fstat(descriptor_, &status) != 0) throw_system_error("read", path, errno);
  return uint64_t(status.st_size);
}

size_t File::read_at(uint64_t offset, void* out, size_t size, const std::filesystem::path& path) const {
  size_t done = 0;
  while (done < size) {
    const ssize_t got = ::pread(descriptor_, static_cast<char*>(out) + done, size - done, off_t(offset + done));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) throw_system_error("read", path, errno);
    if (got == 0) break;
    done += size_t(got);
  }
  return done;
}

void File::write_at(uint64_t offset, const void* data, size_t size, const std::filesystem::path& path) const {
  size_t done = 0;
  while (done < size) {
    const ssize_t put = ::pwrite(descriptor_, static_cast<const char*>(data) + done, size - done, off_t(offset + done));
    if (put < 0 && errno == EINTR) continue;
    if (put < 0) throw_system_error("write", path, errno);
    done += size_t(put);
  }
}

void File::close(const std::filesystem::path& path) {
  if (::close(std::exchange(descriptor_, -1)) != 0 && errno != EINTR) throw_system_error("write", path, errno);
}

void File::sync_and_close(const std::filesystem::path& path) {
  // Devices and pipes cannot be synced, which is no failure.
  const bool synced = ::fsync(descriptor_) == 0 || errno == EINVAL || errno == EROFS;
  if (!synced) throw_system_error("write", path, errno);
  close(path);
}

std::string irregular_kind(std::filesystem::file_type type) {
  using Type = std::filesystem::file_type;
  switch (type) {
    case Type::directory:
      return "a folder";
    case Type::fifo:
      return "a pipe";
    case Type::socket:
      return "a socket";
    case Type::character:
    case Type::block:
      return "a device";
    default:
      return "";
  }
}

File open_to_read(const std::filesystem::path& path) {
  File file = File::open(path, O_RDONLY | O_NONBLOCK);  // which keeps a pipe without a writer from blocking
  struct stat status;
  if (!file.ok() || ::fstat(file.descriptor(), &status) != 0) throw_system_error("read", path, errno);
  if (S_ISREG(status.st_mode)) return file;
  std::error_code failure;
  const std::string kind = irregular_kind(std::filesystem::status(path, failure).type());
  throw FileError(fmt::format("cannot read {}: it is {}; expected a regular file", path.string(), kind), EINVAL);
}

std::string read_file(const std::filesystem::path& path, uint64_t most) {
  constexpr size_t piece = size_t{1} << 16;
  const File file = open_to_read(path);
  std::string text;
  for (;;) {  // the reported size is wrong for files in /proc
    const size_t before = text.size();
    text.resize(before + piece);
    const size_t got = file.read_at(before, text.data() + before, piece, path);
    text.resize(before + got);
    if (text.size() > most)
      throw FileError(fmt::format("cannot read {}: it has more than {} bytes", path.string(), most), EFBIG);
    if (got < piece) return text;
  }
}

void write_file(const std::filesystem::path& path, std::string_view bytes, bool sync) {
  File file = File::open(path, O_WRONLY | O_CREAT | O_TRUNC);
  if (!file.ok()) throw_system_error("write", path, errno);
  while (!bytes.empty()) {
    const ssize_t put = ::write(file.descriptor(), bytes.data(), bytes.size());
    if (put < 0 && errno == EINTR) continue;
    if (put < 0) throw_system_error("write", path, errno);
    bytes.remove_prefix(size_t(put));
  }
  sync ? file.sync_and_close(path) : file.close(path);
}

std::optional<Digest> content_digest(const File& file, const std::filesystem::path& path) {
  constexpr size_t piece = size_t{1} << 20;
  std::vector<uint8_t> buffer(piece);
  Hasher hasher;
  hasher.add("file");
  uint64_t size = 0;
  try {
    while (const size_t got = file.read_at(size, buffer.data(), piece, path)) {
      hasher.stream(buffer.data(), got);
      size += got;
    }
  } catch (const FileError&) {
    return std::nullopt;
  }
  return hasher.add(int64_t(size)).digest();
}

std::optional<Digest> content_digest(const std::filesystem::path& path) {
  try {
    return content_digest(open_to_read(path), path);
  } catch (const FileError&) {
    return std::nullopt;
  }
}

std::string system_message(int code) {
  if (code == EMFILE) return "the program has as many files open as its limit on open files allows (ulimit -n)";
  return std::generic_category().message(code);
}

void throw_system_error(std::string_view verb, const std::filesystem::path& path, int code) {
  throw FileError(fmt::format("cannot {} {}: {}", verb, path.string(), system_message(code)), code);
}

}  // namespace terrazzo
