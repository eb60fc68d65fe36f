#include "runner/cache/cache_pins.h"

#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <vector>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "core/base/processes.h"
#include "runner/cache/cache_folder.h"

namespace terrazzo {

namespace {

/// If a lock is unavailable, values in use may be evicted, which only costs time.
constexpr std::chrono::milliseconds patience{10000};

constexpr int64_t trusted_without_lock_ns = 24 * 3600 * ns_per_second;

/// A lock ends when its last descriptor is closed; this one is released as soon as the reader is done.
bool is_alive(const File& file, const std::string& name) {
  const bool locked_by_us = lock_file(file, LOCK_EX | LOCK_NB);
  if (!locked_by_us && errno == EWOULDBLOCK) return true;
  if (locked_by_us && name.starts_with(host_name() + "-")) return false;
  struct stat status;
  return ::fstat(file.descriptor(), &status) == 0 && now_ns() - ns_of(status.st_mtim) < trusted_without_lock_ns;
}

void add_pins(const File& file, const std::filesystem::path& path, std::set<Digest>& values) {
  std::vector<uint8_t> bytes(file.size(path));
  const size_t size = file.read_at(0, bytes.data(), bytes.size(), path);
  for (size_t at = 0; at + sizeof(Digest) <= size; at += sizeof(Digest)) {
    Digest d;
    std::memcpy(&d, &bytes[at], sizeof d);
    values.insert(d);
  }
}

}  // namespace

LivePins read_live_pins(const std::filesystem::path& folder) {
  LivePins live;
  std::error_code failure;
  for (const auto& entry : std::filesystem::directory_iterator(folder, failure)) {
    const std::filesystem::path& path = entry.path();
    File file = File::open(path, O_RDWR);
    if (!file.ok()) file = File::open(path, O_RDONLY | O_NONBLOCK);
    if (!file.ok()) continue;
    const std::string name = path.filename().string();
    if (!is_alive(file, name)) {
      ::unlink(path.c_str());
      live.dead++;
      continue;
    }
    live.owners.insert(name);
    add_pins(file, path, live.values);
  }
  return live;
}

EvictionLock::EvictionLock(const std::filesystem::path& lock) : file_(File::open(lock, O_RDWR | O_CREAT)) {
  if (file_.ok()) lock_file_soon(file_, LOCK_EX, patience);
}

Pins::Pins(const std::filesystem::path& folder, const std::filesystem::path& lock)
    : lock_(File::open(lock, O_RDWR | O_CREAT)) {
  static std::atomic<unsigned> counter{0};
  if (lock_.ok()) lock_file_soon(lock_, LOCK_SH, patience);
  do {
    owner_ = fmt::format("{}-{}-{}", host_name(), ::getpid(), counter++);
    path_ = folder / owner_;
    file_ = File::open(path_, O_RDWR | O_CREAT | O_EXCL);
    failure_ = file_.ok() ? 0 : errno;
  } while (failure_ == EEXIST);
  if (file_.ok()) lock_file(file_, LOCK_EX | LOCK_NB);
  if (lock_.ok()) lock_file(lock_, LOCK_UN);
}

Pins::~Pins() {
  if (file_.ok()) ::unlink(path_.c_str());
}

void Pins::pin(const Digest& value) {
  const std::lock_guard guard(mutex_);
  if (!file_.ok() || pinned_.count(value)) return;
  if (lock_.ok()) lock_file_soon(lock_, LOCK_SH, patience);
  try {
    file_.write_at(pinned_.size() * sizeof value, &value, sizeof value, path_);
    pinned_.insert(value);
  } catch (const FileError&) {
    // On a full disk the value may be evicted, which only costs time.
  }
  if (lock_.ok()) lock_file(lock_, LOCK_UN);
}

}  // namespace terrazzo
