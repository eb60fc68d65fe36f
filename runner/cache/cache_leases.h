#pragma once

#include <filesystem>
#include <memory>

#include "core/base/hash.h"
#include "core/file/file_io.h"

/// Leases keep processes that share a cache from computing a stage twice. The process that computes it holds a file in
/// leases/, named after the stage's key and locked with flock; the others wait for the result. The lock ends with the
/// process, however that ends.
namespace terrazzo {

/// Releases the stage when destroyed.
class Lease {
 public:
  Lease(std::filesystem::path path, File file) : path_(std::move(path)), file_(std::move(file)) {}
  ~Lease();
  Lease(const Lease&) = delete;
  Lease& operator=(const Lease&) = delete;

 private:
  std::filesystem::path path_;
  File file_;
};

struct LeaseAttempt {
  std::shared_ptr<Lease> lease;  ///< null if taken, or if leases do not work in this folder
  bool taken = false;            ///< by another process, or another holder in this one
};

/// Never waits. Gives no lease if files cannot be written or locked.
LeaseAttempt try_lease(const std::filesystem::path& folder, const Digest& key);

/// Whether the stage's lease is taken; false if unknown. Changes nothing.
bool lease_is_taken(const std::filesystem::path& folder, const Digest& key);

/// Removes the lease files of dead processes.
void remove_abandoned_leases(const std::filesystem::path& folder);

}  // namespace terrazzo
