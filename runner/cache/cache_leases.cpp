#include "runner/cache/cache_leases.h"

#include <cerrno>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "runner/cache/cache_pins.h"

namespace terrazzo {

namespace {

/// Whether the file is still the one of that name: who gives a lease up removes its file.
bool is_at(const File& file, const std::filesystem::path& path) {
  struct stat held, there;
  return ::fstat(file.descriptor(), &held) == 0 && ::stat(path.c_str(), &there) == 0 && held.st_ino == there.st_ino &&
         held.st_dev == there.st_dev;
}

}  // namespace

Lease::~Lease() {
  ::unlink(path_.c_str());  // still locked: nobody else's file can have the name
}

LeaseAttempt try_lease(const std::filesystem::path& folder, const Digest& key) {
  const std::filesystem::path path = folder / key.hex();
  constexpr int most_tries = 100;  // files come and go, but not for ever
  for (int i = 0; i < most_tries; i++) {
    File file = File::open(path, O_RDWR | O_CREAT);
    if (!file.ok()) return {};
    if (!lock_file(file, LOCK_EX | LOCK_NB)) return {nullptr, errno == EWOULDBLOCK};
    if (is_at(file, path)) return {std::make_shared<Lease>(path, std::move(file)), false};
  }
  return {};
}

bool lease_is_taken(const std::filesystem::path& folder, const Digest& key) {
  const File file = File::open(folder / key.hex(), O_RDWR);
  // The file goes with the lease, unless its owner was killed: then nobody locks it.
  return file.ok() && !lock_file(file, LOCK_SH | LOCK_NB) && errno == EWOULDBLOCK;
}

void remove_abandoned_leases(const std::filesystem::path& folder) {
  std::error_code failure;
  for (const auto& entry : std::filesystem::directory_iterator(folder, failure)) {
    const File file = File::open(entry.path(), O_RDWR);
    if (file.ok() && lock_file(file, LOCK_EX | LOCK_NB) && is_at(file, entry.path())) ::unlink(entry.path().c_str());
  }
}

}  // namespace terrazzo
