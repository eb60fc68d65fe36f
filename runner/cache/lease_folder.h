#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

/// The folder of one lease on disk, see runner/cache/cache_leases.h.
namespace terrazzo {

/// The holder of a lease, and how often it has renewed it: the name of the file in the folder.
struct LeaseHolder {
  std::string who;
  uint64_t beat = 0;
  bool operator==(const LeaseHolder&) const = default;

  std::string file() const { return who + "." + std::to_string(beat); }
};

/// A unique name: this process and a counter.
std::string new_lease_holder();
/// Whether the holder is a dead process of this machine; false if unknown.
bool is_dead(const std::string& who);

/// The holder of the lease; nullopt if there is none. A plain file, written by earlier versions, has no holder.
std::optional<LeaseHolder> holder_of(const std::filesystem::path& lease);
/// Creates the lease unless it is held. Also returns false if folders cannot be created; errno then differs from
/// EEXIST.
bool claim_lease(const std::filesystem::path& lease, const LeaseHolder& holder);
/// Renews the lease. Returns false if the holder has lost it.
bool renew_lease(const std::filesystem::path& lease, LeaseHolder& holder);
/// Releases the lease if the holder still has it.
void release_lease(const std::filesystem::path& lease, const LeaseHolder& holder);
/// Removes the lease of the holder `seen`, unless it has been renewed since or has another holder. An empty folder has
/// no holder.
void take_lease_away(const std::filesystem::path& lease, const LeaseHolder& seen);

}  // namespace terrazzo
