#include "core/file/scratch_file.h"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <string>

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include "core/base/error.h"

namespace terrazzo {

namespace {

[[noreturn]] void fail(const char* what) {
  throw Error(fmt::format("cannot {} a temporary file in {}: {}; set TMPDIR to another folder", what,
                          std::filesystem::temp_directory_path().string(), std::strerror(errno)));
}

}  // namespace

ScratchFile& ScratchFile::shared() {
  static ScratchFile& file = *new ScratchFile;  // outlives all its users
  return file;
}

ScratchFile::~ScratchFile() {
  if (file_ >= 0) ::close(file_);
}

bool ScratchFile::open() {
  if (file_ >= 0) return true;
  std::error_code missing;
  std::string path = (std::filesystem::temp_directory_path(missing) / ("terrazzo-" + std::string(6, 'X'))).string();
  if (missing) return false;
  file_ = ::mkostemp(path.data(), O_CLOEXEC);
  if (file_ >= 0) ::unlink(path.c_str());
  return file_ >= 0;
}

std::optional<uint64_t> ScratchFile::take_free(uint64_t bytes) {
  for (auto at = free_.begin(); at != free_.end(); ++at) {
    if (at->second < bytes) continue;
    const auto [begin, room] = *at;
    free_.erase(at);
    if (room > bytes) free_.emplace(begin + bytes, room - bytes);
    return begin;
  }
  return std::nullopt;
}

std::optional<uint64_t> ScratchFile::take(uint64_t bytes) {
  const std::lock_guard lock(mutex_);
  if (const auto found = take_free(bytes)) return found;
  // Reserves the space now: a failure later would stop a computation.
  if (!open() || ::posix_fallocate(file_, off_t(end_), off_t(bytes)) != 0) return std::nullopt;
  const uint64_t at = end_;
  end_ += bytes;
  return at;
}

void ScratchFile::give_back(uint64_t at, uint64_t bytes) {
  const std::lock_guard lock(mutex_);
  auto next = free_.upper_bound(at);
  if (next != free_.end() && at + bytes == next->first) {
    bytes += next->second;
    next = free_.erase(next);
  }
  if (next != free_.begin()) {
    const auto before = std::prev(next);
    if (before->first + before->second == at) {
      at = before->first;
      bytes += before->second;
      free_.erase(before);
    }
  }
  if (at + bytes == end_ && ::ftruncate(file_, off_t(at)) == 0)
    end_ = at;
  else
    free_.emplace(at, bytes);
}

void ScratchFile::write(uint64_t at, const void* data, uint64_t bytes) {
  for (const char* from = static_cast<const char*>(data); bytes > 0;) {
    const ssize_t n = ::pwrite(file_, from, bytes, off_t(at));
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) fail("write");
    from += n;
    at += uint64_t(n);
    bytes -= uint64_t(n);
  }
}

void ScratchFile::read(uint64_t at, void* data, uint64_t bytes) const {
  for (char* to = static_cast<char*>(data); bytes > 0;) {
    const ssize_t n = ::pread(file_, to, bytes, off_t(at));
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) fail("read");
    to += n;
    at += uint64_t(n);
    bytes -= uint64_t(n);
  }
}

uint64_t ScratchFile::size() const {
  const std::lock_guard lock(mutex_);
  return end_;
}

}  // namespace terrazzo
