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
  /// The folder of the cache; empty: the usual one, see Cache::default_folder.
  std::filesystem::path cache{};
  bool use_cache = true;  ///< false: nothing is reused and nothing is kept
  int threads = 0;        ///< 0: one per core
  uint64_t memory = 0;    ///< budget in bytes for values and running nodes of a run; 0: that of set_memory_budget
  /// Runs every node twice, one at a time and without a cache: one that gives something else the second time fails.
  /// What nodes open and which variables they read is watched too, where the watching library was loaded before all
  /// others, as it is by `terrazzo run --checked`; what nodes in Python open is watched always.
  bool checked = false;
};

struct RunRequest {
  std::vector<std::string> only{};   ///< only these nodes and what they need; empty: all sinks, or what nothing reads
  std::vector<std::string> keep{};   ///< nodes whose values come back in RunResult::kept
  bool keep_going = false;           ///< after a failure, goes on with everything that does not need the failed node
  bool look_ahead = true;            ///< false: what is certain to fail is found by the run, not by the plan
  const Sandbox* sandbox = nullptr;  ///< keeps nodes from files elsewhere; may be null
  RunObserver* observer = nullptr;   ///< is told what happens, from any thread
  const std::atomic<bool>* cancelled = nullptr;  ///< set it to stop the run within a second; may be null
};

/// A cache that is open, and how to run. Jobs may run at the same time, from different threads: they share the cache,
/// and each has the session's threads and memory. What decoded images take is counted for the whole process, as they
/// are shared: set_memory_budget (core/image/image_limits.h) bounds that, and all else where a session says nothing.
/// What the cache holds beyond its limit is removed after runs. Throws from the constructor only if the cache cannot be
/// opened.
class Session {
 public:
  explicit Session(SessionOptions options = {});
  /// With a cache that is open already, or none; `options` say nothing about it then.
  Session(std::shared_ptr<Cache> cache, const SessionOptions& options);
  ~Session();
  Session(const Session&) = delete;
  Session& operator=(const Session&) = delete;

  /// What a run would do, and why. Throws GraphError, and Error for names in `request` that are no nodes. The job must
  /// outlive the plan.
  Plan plan(const CheckedJob& job, const RunRequest& request = {});
  /// The same for a graph that a program has put together. The graph must outlive the plan.
  Plan plan(const Graph& graph, const RunRequest& request = {});
  /// Runs what must run. Failures and cancellation are in the result; throws what plan() throws. Values that are kept
  /// may be lazy: their pixels are computed when they are read, and need neither the job nor the session.
  RunResult run(const CheckedJob& job, const RunRequest& request = {});
  RunResult run(const Graph& graph, const RunRequest& request = {});
  /// Runs a plan that this session has made for the same request.
  RunResult run(Plan plan, const RunRequest& request);
  /// What only cost time since the last call (a full disk, a damaged entry), one line each.
  std::vector<std::string> take_warnings();

  /// Null if it has none.
  Cache* cache() const { return cache_.get(); }

 private:
  RunOptions options_for(const Graph& graph, const RunRequest& request) const;
  RunResult run(Plan plan, const RunRequest& request, History* history);

  SessionOptions options_;
  std::shared_ptr<Cache> cache_;
};

}  // namespace terrazzo
