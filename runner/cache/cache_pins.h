#pragma once

#include <filesystem>
#include <mutex>
#include <set>
#include <string>

#include "core/base/hash.h"
#include "core/file/file_lock.h"

/// Pins tell other processes which values are in use. Each Cache object has a file in pins/, locked with flock while
/// the object lives, to which it appends the digests it uses. Eviction reads all locked files; unlocked ones belong to
/// dead processes. Pinning takes the folder's lock shared, eviction takes it exclusively, so that nothing is pinned
/// between reading pins and removing values.
namespace terrazzo {

/// Values and owners in use by running processes.
struct LivePins {
  std::set<Digest> values;
  std::set<std::string> owners;
  int dead = 0;  ///< number of files of dead processes
};

/// Reads all pins and removes the files of dead processes. If locks do not work, and for other hosts, whose locks may
/// be invisible, files touched within a day count as alive.
LivePins read_live_pins(const std::filesystem::path& folder);

/// Holds the folder's lock exclusively. Has no effect if files cannot be locked.
class EvictionLock {
 public:
  explicit EvictionLock(const std::filesystem::path& lock);

 private:
  File file_;
};

/// This object's own pins. Thread-safe.
class Pins {
 public:
  /// Pins nothing if the folder is not writable, see failure().
  Pins(const std::filesystem::path& folder, const std::filesystem::path& lock);
  ~Pins();
  Pins(const Pins&) = delete;
  Pins& operator=(const Pins&) = delete;

  /// Host, process and a counter: unique to this Cache object.
  const std::string& owner() const { return owner_; }
  /// errno if pins do not work; else 0.
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
