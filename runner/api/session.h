#pragma once

#include <atomic>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "runner/api/job.h"
#include "runner/engine/schedule.h"
#include "runner/plan/plan.h"

/// Runs jobs, for programs.
namespace terrazzo {

struct SessionOptions {
  /// The folder of the cache; empty: Cache::default_folder.
  std::filesystem::path cache{};
  bool use_cache = true;  ///< false: nothing is reused and nothing is kept
  int threads = 0;        ///< 0: one per core
  uint64_t memory = 0;    ///< bytes that a run's values and running nodes may take; 0: as set_memory_budget
  /// Runs every node twice, one at a time and without a cache. A node whose second result differs fails. Also watches
  /// which files nodes open and which environment variables they read. For C++ nodes this requires the preloaded watch
  /// library, as in `terrazzo run --checked`.
  bool checked = false;
};

struct RunRequest {
  /// Only these nodes and what they need; empty: all sinks, or, without sinks, all nodes that nothing reads.
  std::vector<std::string> only{};
  std::vector<std::string> keep{};   ///< nodes whose values come back in RunResult::kept
  bool keep_going = false;           ///< after a failure, continues with nodes that do not depend on the failed one
  bool look_ahead = true;            ///< false: skips preflight checks; errors then show up during the run
  const Sandbox* sandbox = nullptr;  ///< restricts which files nodes may read and write; may be null
  RunObserver* observer = nullptr;   ///< called from any thread; may be null
  const std::atomic<bool>* cancelled = nullptr;  ///< set it to stop the run within a second; may be null
};

/// An open cache and options for running. Thread-safe: jobs may run concurrently from different threads. They share the
/// cache; each gets the session's threads and memory. Decoded images are shared by the whole process and count against
/// set_memory_budget (core/image/image_limits.h), which is also the default of SessionOptions::memory. Runs evict
/// entries that exceed the cache's limit. The constructor throws Error if the cache cannot be opened.
class Session {
 public:
  explicit Session(SessionOptions options = {});
  /// Uses an open cache, or none if null; ignores the cache settings in `options`.
  Session(std::shared_ptr<Cache> cache, const SessionOptions& options);
  ~Session();
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  /// What a run would do, and why. Throws GraphError, and Error for unknown nodes in `request`. The job must outlive
  /// the plan.
  Plan plan(const CheckedJob& job, const RunRequest& request = {});
  /// The same for a graph built by a program. The graph must outlive the plan.
  Plan plan(const Graph& graph, const RunRequest& request = {});
  /// Plans, then runs. The result reports failures and cancellation; throws as plan(). Kept values may be lazy: their
  /// pixels are computed when read, without the job or the session.
  RunResult run(const CheckedJob& job, const RunRequest& request = {});
  RunResult run(const Graph& graph, const RunRequest& request = {});
  /// Runs a plan that this session has made for the same request.
  RunResult run(Plan plan, const RunRequest& request);
  /// Cache problems since the last call that cost only time (a full disk, a damaged entry), one line each.
  std::vector<std::string> take_warnings();

  /// Null if the session has no cache.
  Cache* cache() const { return cache_.get(); }

 private:
  RunOptions options_for(const Graph& graph, const RunRequest& request) const;
  RunResult run(Plan plan, const RunRequest& request, History* history);

  SessionOptions options_;
  std::shared_ptr<Cache> cache_;
};

}  // namespace terrazzo
