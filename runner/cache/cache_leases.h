#pragma once

#include <chrono>
#include <filesystem>
#include <memory>

#include "core/base/hash.h"

/// Leases prevent processes that share a cache from computing a stage twice. The process that computes it holds a
/// folder in leases/, named after the stage's key; the others wait for the result. The folder contains a file whose
/// name identifies the holder. The holder renames it every second:
///
///   leases/<key>/<neighbourhood>-<process>-<count>.<beat>
///
/// A process that sees the same name for `expiry` takes over the lease: the holder was killed on another machine, or
/// was stopped. A stopped holder that resumes finds its file gone and does no harm: it stores the same bytes. A lease
/// of a dead process on this machine is free at once. The protocol relies only on renaming, which is atomic on network
/// file systems, and on each process's own clock.
namespace terrazzo {

struct LeaseTimes {
  std::chrono::milliseconds beat{1000};     ///< time between renewals
  std::chrono::milliseconds expiry{10000};  ///< time without renewal until a lease expires
};

/// The exclusive right to compute a stage, released by the destructor.
class Lease {
 public:
  virtual ~Lease() = default;
};

struct LeaseAttempt {
  std::shared_ptr<Lease> lease;  ///< null if taken, or if leases do not work in this folder
  bool taken = false;            ///< held by another process, or elsewhere in this one
};

/// One process's access to the leases in a folder. A background thread renews the held ones. Thread-safe.
class Leases {
 public:
  explicit Leases(std::filesystem::path folder, LeaseTimes times = {});
  ~Leases();
  Leases(const Leases&) = delete;
  Leases& operator=(const Leases&) = delete;

  /// Never waits. Returns no lease if files cannot be written.
  LeaseAttempt try_lease(const Digest& key);
  /// Whether the stage's lease is taken and not expired; false if unknown. Changes nothing in the folder.
  bool is_taken(const Digest& key);
  /// Removes leases of dead processes, and those not renewed for a day.
  void remove_abandoned();

 private:
  class State;
  class Held;
  std::shared_ptr<State> state_;  ///< shared with the leases, which may outlive this
};

}  // namespace terrazzo
