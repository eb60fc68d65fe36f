#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

/// The folder of one lease on disk, see runner/cache/cache_leases.h.
namespace terrazzo {

/// Who holds a lease, and how often it has been renewed: the name of the file in it.
struct LeaseHolder {
  std::string who;
  uint64_t beat = 0;
  bool operator==(const LeaseHolder&) const = default;

  std::string file() const { return who + "." + std::to_string(beat); }
};

/// A name that nobody else has: of this process, with a count.
std::string new_lease_holder();
/// Whether it is a process of this machine that does not run any more; false if that cannot be told.
bool is_dead(const std::string& who);

/// Who holds the lease; none if nobody does. A file, as earlier versions made it, is nobody's.
std::optional<LeaseHolder> holder_of(const std::filesystem::path& lease);
/// Makes the lease, unless somebody holds it. False also if folders cannot be made there: errno is then other than
/// EEXIST.
bool claim_lease(const std::filesystem::path& lease, const LeaseHolder& holder);
/// The holder's next beat. False if it holds the lease no more.
bool renew_lease(const std::filesystem::path& lease, LeaseHolder& holder);
/// Gives up the lease if the holder still has it.
void release_lease(const std::filesystem::path& lease, const LeaseHolder& holder);
/// Takes the lease from a holder as it was seen; leaves it if that has renewed it since, or another has come. An empty
/// folder is nobody's.
void take_lease_away(const std::filesystem::path& lease, const LeaseHolder& seen);

}  // namespace terrazzo
