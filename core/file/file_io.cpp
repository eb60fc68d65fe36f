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
  const File file = File::open(path, O_RDONLY | O_NONBLOCK);
  return file.ok() ? content_digest(file, path) : std::nullopt;
}

std::string system_message(int code) {
  return std::generic_category().message(code);
}

std::string host_name() {
  std::array<char, 256> name{};
  return ::gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "host";
}

void throw_system_error(std::string_view verb, const std::filesystem::path& path, int code) {
  throw FileError(fmt::format("cannot {} {}: {}", verb, path.string(), system_message(code)), code);
}

}  // namespace terrazzo
