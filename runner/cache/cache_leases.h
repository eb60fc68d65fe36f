#pragma once

#include <filesystem>
#include <memory>

#include "core/base/hash.h"
#include "core/file/file_io.h"

/// How processes that share a cache keep from computing the same stage at once. Who computes one holds a file in
/// leases/, named after the stage's key and locked with flock; the others wait and then find the result. The lock goes
/// with the process, however it ends, so that nobody waits for the dead.
namespace terrazzo {

/// Gives the stage up when it goes.
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
  std::shared_ptr<Lease> lease;  ///< null: somebody else has it, or there is none to be had
  bool taken = false;            ///< somebody else has it
};

/// Does not wait. Where files cannot be written or locked there are no leases.
LeaseAttempt try_lease(const std::filesystem::path& folder, const Digest& key);

/// Whether somebody has the stage's lease; takes and leaves nothing. False where that cannot be told.
bool lease_is_taken(const std::filesystem::path& folder, const Digest& key);

/// Removes the files of processes that were killed.
void remove_abandoned_leases(const std::filesystem::path& folder);

}  // namespace terrazzo
