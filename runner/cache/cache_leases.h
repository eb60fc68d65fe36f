#pragma once

#include <chrono>
#include <filesystem>
#include <memory>

#include "core/base/hash.h"

/// Leases keep processes that share a cache from computing a stage twice. The process that computes it holds a folder
/// in leases/, named after the stage's key; the others wait for the result. In the folder lies a file whose name says
/// who holds it and is changed every second by renaming:
///
///   leases/<key>/<neighbourhood>-<process>-<count>.<beat>
///
/// Whoever sees one name for as long as `expiry` takes the lease over: its holder was killed on another machine, or has
/// been stopped. A stopped one that goes on finds its file gone, and disturbs nobody: it stores the same bytes. What is
/// held by a dead process of this machine is free at once. All of it works by renaming, which network file systems do
/// at once or not at all, and by each process's own clock.
namespace terrazzo {

struct LeaseTimes {
  std::chrono::milliseconds beat{1000};     ///< between renewals
  std::chrono::milliseconds expiry{10000};  ///< without a renewal
};

/// Releases the stage when destroyed.
class Lease {
 public:
  virtual ~Lease() = default;
};

struct LeaseAttempt {
  std::shared_ptr<Lease> lease;  ///< null if taken, or if leases do not work in this folder
  bool taken = false;            ///< by another process, or another holder in this one
};

/// The leases in a folder, as one process sees and holds them. A thread renews those that it holds. Thread-safe.
class Leases {
 public:
  explicit Leases(std::filesystem::path folder, LeaseTimes times = {});
  ~Leases();
  Leases(const Leases&) = delete;
  Leases& operator=(const Leases&) = delete;

  /// Never waits. Gives no lease if files cannot be written.
  LeaseAttempt try_lease(const Digest& key);
  /// Whether the stage's lease is taken, and has not expired; false if unknown. Changes nothing in the folder.
  bool is_taken(const Digest& key);
  /// Removes what dead processes hold, and what nobody has renewed for a day.
  void remove_abandoned();

 private:
  class State;
  class Held;
  std::shared_ptr<State> state_;  ///< shared with the leases, which may outlive this
};

}  // namespace terrazzo
