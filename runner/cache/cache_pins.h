#pragma once

#include <filesystem>
#include <mutex>
#include <set>
#include <string>

#include "core/base/hash.h"
#include "core/file/file_io.h"

/// How processes tell each other which values they use. Each Cache object holds a file in pins/, locked with flock for
/// as long as the object lives, to which it appends the digests it has asked for. Whoever evicts reads the files that
/// are locked; one that is not belonged to a dead process. Pinning takes the folder's lock shared and evicting takes
/// it exclusively, so that nothing is pinned between looking at the pins and removing a value.
namespace terrazzo {

/// flock(2), uninterrupted; false if it fails, and errno says why.
bool lock_file(const File& file, int operation);

/// What running processes use.
struct LivePins {
  std::set<Digest> values;
  std::set<std::string> owners;
};

/// Reads all pins and removes the files of dead processes. Where files cannot be locked (and for files of other hosts,
/// whose locks may not be seen here) those touched within a day count as alive.
LivePins read_live_pins(const std::filesystem::path& folder);

/// Holds the folder's lock exclusively; does nothing where files cannot be locked.
class EvictionLock {
 public:
  explicit EvictionLock(const std::filesystem::path& lock);

 private:
  File file_;
};

/// This object's own pins. Thread-safe.
class Pins {
 public:
  /// Without a writable folder there are no pins; failure() tells.
  Pins(const std::filesystem::path& folder, const std::filesystem::path& lock);
  ~Pins();
  Pins(const Pins&) = delete;
  Pins& operator=(const Pins&) = delete;

  /// Host, process and a counter: no other Cache object has the same.
  const std::string& owner() const { return owner_; }
  /// The operating system's error number if there are no pins; else 0.
  int failure() const { return failure_; }
  void pin(const Digest& value);

 private:
  std::filesystem::path path_;
  std::string owner_;
  File lock_;
  File file_;
  int failure_ = 0;
  std::mutex mutex_;
  std::set<Digest> pinned_;
};

}  // namespace terrazzo
