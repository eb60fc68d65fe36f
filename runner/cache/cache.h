#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/base/task.h"
#include "core/node/value.h"
#include "runner/cache/cache_leases.h"
#include "runner/cache/stage_record.h"

namespace terrazzo {

class CacheState;

struct CacheStatus {
  uint64_t bytes = 0;
  uint64_t limit = 0;
  int64_t stages = 0;
  int64_t values = 0;
  int64_t histories = 0;   ///< graphs with a recorded last run
  std::string limit_from;  ///< the source of the limit, see runner/cache/cache_limit.h; empty if set by the program
};

/// The result of verifying all entries.
struct CacheVerdict {
  std::vector<std::string> damaged;  ///< one line per damaged entry
  int left = 0;                      ///< number of damaged entries that could not be removed
};

/// The result of an eviction.
struct CacheCollection {
  uint64_t freed = 0;    ///< bytes
  size_t looked_at = 0;  ///< entries
};

/// A content-addressed cache in a folder that any number of threads, processes and machines may share. A stage record
/// maps a stage's key to the digests of its values; values are stored by digest. Files are written to a temporary name
/// in the same folder, synced if they took long to compute, and renamed; records are written after their values.
/// Everything has a checksum, and damaged, incomplete or missing entries count as misses. Thread-safe. Only the
/// constructor throws for problems of the cache itself; later ones become warnings.
class Cache {
 public:
  /// $TERRAZZO_CACHE, or terrazzo under $XDG_CACHE_HOME, or ~/.cache/terrazzo.
  static std::filesystem::path default_folder();

  /// Opens or creates the folder; throws Error if that fails. `limit`: in bytes; 0: from the environment or the
  /// folder's settings. Throws Error if those are invalid.
  explicit Cache(const std::filesystem::path& folder, uint64_t limit = 0);
  ~Cache();
  Cache(const Cache&) = delete;
  Cache& operator=(const Cache&) = delete;

  const std::filesystem::path& folder() const;
  /// In bytes.
  uint64_t limit() const;

  std::optional<StageRecord> find_stage(const Digest& key);
  void store_stage(const Digest& key, const StageRecord& record);

  /// Tries to get the exclusive right to compute a stage, see runner/cache/cache_leases.h.
  LeaseAttempt try_lease(const Digest& key);
  /// Whether any process is computing the stage.
  bool is_leased(const Digest& key) const;

  /// Whether the value is stored; only load_value verifies its checksums. Pins the value: no process evicts it while
  /// this Cache object lives.
  bool has_value(const Digest& value);
  std::optional<Value> load_value(const Digest& value);
  /// The value's size on disk in bytes; 0 if it is not stored.
  uint64_t stored_bytes(const Digest& value) const;
  /// `seconds`: the time to compute the value, for eviction. Throws Cancelled.
  void store_value(const Value& value, double seconds, const Task& task);

  /// The digest of a file's content, memoised by path, size and times (see FileStamp). A fixed digest if the file is
  /// missing or unreadable.
  Digest file_digest(const std::filesystem::path& path);

  /// Problems since the last call that only cost time (a full disk, a damaged entry), one line each.
  std::vector<std::string> take_warnings();

  CacheStatus status();
  /// Reads every entry and removes damaged ones. Throws Cancelled.
  CacheVerdict verify(const Task& task);
  /// Evicts entries until the cache is within its limit, by seconds to recompute per byte and by age. Keeps entries
  /// pinned by running processes. Removes the stage records of evicted values too. Returns the bytes freed.
  uint64_t collect();
  /// The same at the end of a run, if necessary: scans the entries only if the recorded total exceeds the limit or is
  /// unreliable (see runner/cache/cache_total.h).
  CacheCollection collect_if_due();
  /// Removes all entries except those pinned by running processes. Returns the bytes freed.
  uint64_t clear();

 private:
  CacheCollection collect_all();

  std::unique_ptr<CacheState> state_;
};

/// The digest of a file's content, not memoised; the same fixed digest if it is missing or unreadable.
Digest file_content_digest(const std::filesystem::path& path);

}  // namespace terrazzo
