#include "core/file/file_stamp.h"

#include <algorithm>

#include <sys/stat.h>

namespace terrazzo {

namespace {

constexpr int64_t unsettled_ns = 2 * ns_per_second;

std::optional<FileStamp> stamp_in(const struct stat& status) {
  if (!S_ISREG(status.st_mode)) return std::nullopt;
  return FileStamp{uint64_t(status.st_size), ns_of(status.st_mtim), ns_of(status.st_ctim), uint64_t(status.st_ino)};
}

}  // namespace

bool FileStamp::is_settled(int64_t at_ns) const {
  return std::max(modified_ns, changed_ns) + unsettled_ns < at_ns;
}

int64_t ns_of(const timespec& t) {
  return int64_t{t.tv_sec} * ns_per_second + t.tv_nsec;
}

int64_t now_ns() {
  timespec t;
  ::clock_gettime(CLOCK_REALTIME, &t);
  return ns_of(t);
}

std::optional<FileStamp> stamp_of(const std::filesystem::path& path) {
  struct stat status;
  return ::stat(path.c_str(), &status) == 0 ? stamp_in(status) : std::nullopt;
}

std::optional<FileStamp> stamp_of(const File& file) {
  struct stat status;
  return file.ok() && ::fstat(file.descriptor(), &status) == 0 ? stamp_in(status) : std::nullopt;
}

}  // namespace terrazzo
