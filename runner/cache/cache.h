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
  int64_t histories = 0;   ///< graphs whose last run is known
  std::string limit_from;  ///< what says so, see runner/cache/cache_limit.h; empty if the program does
};

/// What a check of all entries has found.
struct CacheVerdict {
  std::vector<std::string> damaged;  ///< a line for each such entry
  int left = 0;                      ///< how many of them could not be removed
};

/// What an eviction has done.
struct CacheCollection {
  uint64_t freed = 0;    ///< bytes
  size_t looked_at = 0;  ///< entries
};

/// A content-addressed cache in a folder that any number of threads, processes and machines may share. A stage record
/// maps a stage's key to the digests of its values; values are stored by digest. Everything is written to a temporary
/// name in the same folder, synced if it took long to compute, and renamed, records after their values; everything is
/// checksummed, and whatever is damaged, incomplete or missing is a miss. All functions are thread-safe. Only the
/// constructor throws for problems of the cache itself; others become warnings.
class Cache {
 public:
  /// $TERRAZZO_CACHE, or terrazzo under $XDG_CACHE_HOME, or ~/.cache/terrazzo.
  static std::filesystem::path default_folder();

  /// Opens or creates the folder; throws Error if that fails. `limit`: bytes, 0 = as
  /// the environment and the folder's settings say, which throws Error if they are wrong.
  explicit Cache(const std::filesystem::path& folder, uint64_t limit = 0);
  ~Cache();
  Cache(const Cache&) = delete;
  Cache& operator=(const Cache&) = delete;

  const std::filesystem::path& folder() const;
  /// Bytes.
  uint64_t limit() const;

  std::optional<StageRecord> find_stage(const Digest& key);
  void store_stage(const Digest& key, const StageRecord& record);

  /// Tries to become the only one to compute a stage, see runner/cache/cache_leases.h.
  LeaseAttempt try_lease(const Digest& key);
  /// Whether any process is computing the stage.
  bool is_leased(const Digest& key) const;

  /// Whether the value is stored; only load_value verifies its checksums. Pins the value: no process evicts it while
  /// this Cache object lives.
  bool has_value(const Digest& value);
  std::optional<Value> load_value(const Digest& value);
  /// What the value takes on the disk; 0 if it is not stored.
  uint64_t stored_bytes(const Digest& value) const;
  /// `seconds`: time to compute, for eviction. Throws Cancelled.
  void store_value(const Value& value, double seconds, const Task& task);

  /// The digest of a file's content, memoised by path, size and times (see FileStamp). A fixed digest if the file is
  /// missing or unreadable.
  Digest file_digest(const std::filesystem::path& path);

  /// Problems since the last call that only cost time (a full disk, a damaged entry), one line each.
  std::vector<std::string> take_warnings();

  CacheStatus status();
  /// Reads every entry and removes damaged ones. Throws Cancelled.
  CacheVerdict verify(const Task& task);
  /// Evicts entries until the limit holds, by seconds to recompute per byte and by age, except those pinned by running
  /// processes; with values that were evicted the records of their stages. Returns the bytes freed.
  uint64_t collect();
  /// The same when a run ends, if it may be due: the entries are looked at only if their total, as far as it is known,
  /// is above the limit or not to be relied on (see runner/cache/cache_total.h).
  CacheCollection collect_if_due();
  /// Removes all entries except those pinned by running processes. Returns the bytes freed.
  uint64_t clear();

 private:
  CacheCollection collect_all();

  std::unique_ptr<CacheState> state_;
};

/// The digest of a file's content, not memoised; the fixed digest if it is missing or unreadable.
Digest file_content_digest(const std::filesystem::path& path);

}  // namespace terrazzo
