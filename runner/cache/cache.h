#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/base/task.h"
#include "core/node/value.h"
#include "runner/cache/cache_leases.h"

namespace terrazzo {

/// A file that a sink wrote.
struct OutputFile {
  std::filesystem::path path;
  uint64_t bytes = 0;
  Digest content;
};

/// What is known of a stage that has been computed before.
struct StageRecord {
  std::map<std::string, Digest> outputs;  ///< value digest by output port
  std::vector<std::string> notes;         ///< what the node said
  std::vector<OutputFile> files;          ///< for sinks
  double seconds = 0;                     ///< what it cost to compute
};

struct CacheStatus {
  uint64_t bytes = 0;
  uint64_t limit = 0;
  int64_t stages = 0;
  int64_t values = 0;
};

/// Results by content, in a folder that any number of threads, processes and machines may share. A stage record says,
/// by a stage's key, which values came out; values lie under their own digest. Everything is written to a temporary
/// name in the same folder, synced if it took a while to compute, and renamed, the record after its values; everything
/// is checksummed, and whatever is damaged, half-written or missing is a miss. All functions are thread-safe, and none
/// but the constructor throws for trouble with the cache itself: a cache that cannot be written costs time, not the
/// run.
class Cache {
 public:
  /// $TERRAZZO_CACHE, or terrazzo under $XDG_CACHE_HOME, or ~/.cache/terrazzo.
  static std::filesystem::path default_folder();

  /// Opens or makes the folder. Throws Error if that fails. `limit`: bytes, 0 = the default of 10 GiB.
  explicit Cache(std::filesystem::path folder, uint64_t limit = 0);
  ~Cache();
  Cache(const Cache&) = delete;
  Cache& operator=(const Cache&) = delete;

  const std::filesystem::path& folder() const;

  std::optional<StageRecord> find_stage(const Digest& key);
  void store_stage(const Digest& key, const StageRecord& record);

  /// Asks to be the one who computes a stage, see runner/cache/cache_leases.h.
  LeaseAttempt try_lease(const Digest& key);
  /// Whether somebody is computing the stage.
  bool is_leased(const Digest& key) const;

  /// Whether the value is there (its checksums are only verified by load). A value asked for is pinned: no process
  /// evicts it while this Cache object lives.
  bool has_value(const Digest& value);
  std::optional<Value> load_value(const Digest& value);
  /// `seconds`: what it cost to compute, for eviction.
  void store_value(const Value& value, double seconds, const Task& task);

  /// The digest of a file's content, memoised by path, size and modification time. For a missing or unreadable file a
  /// fixed digest meaning just that.
  Digest file_digest(const std::filesystem::path& path);

  /// Problems met so far that cost nothing but time (a full disk, a damaged entry), one line each, for the log.
  std::vector<std::string> take_warnings();

  CacheStatus status();
  /// Reads every entry; returns one line per damaged one and removes it.
  std::vector<std::string> verify(const Task& task);
  /// Evicts until the limit holds, by seconds to recompute per byte and by age; never what a running process has
  /// pinned. Returns the bytes freed. Called by the runner when a run ends.
  uint64_t collect();
  /// Removes every entry that no running process has pinned. Returns the bytes freed.
  uint64_t clear();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// The digest of a file's content without a memo; the fixed "missing" digest as above.
Digest file_content_digest(const std::filesystem::path& path);

}  // namespace terrazzo
