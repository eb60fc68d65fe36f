#pragma once

#include <atomic>
#include <chrono>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "runner/engine/plan.h"

namespace terrazzo {

class Sandbox;

/// Receives the events of a run. Calls come from any thread, concurrently, and must return quickly. Every needed stage
/// gets one of finished, reused, spared, failed and skipped, unless the run ends before.
class RunObserver {
 public:
  virtual ~RunObserver() = default;
  virtual void planned(const Plan&) {}
  virtual void started(const Stage&) {}
  /// Another process is computing it; called once.
  virtual void waits(const Stage&) {}
  virtual void progressed(const Stage&, double /*fraction*/) {}
  virtual void noted(const Stage&, const std::string& /*message*/) {}
  virtual void finished(const Stage&, double /*seconds*/) {}
  /// It did not have to run: its result is cached, or its files are up to date.
  virtual void reused(const Stage&) {}
  /// Its result was not needed after all, and does not exist.
  virtual void spared(const Stage&) {}
  virtual void failed(const Stage&, const std::string& /*message*/) {}
  /// It cannot run, as the node `because`, which it needs, has failed. Only with `targets.keep_going`.
  virtual void skipped(const Stage&, const std::string& /*because*/) {}
};

struct RunOptions {
  PlanOptions targets;
  Cache* cache = nullptr;      ///< null: nothing is reused and nothing is kept
  History* history = nullptr;  ///< for the reasons in plans; updated by the run
  int threads = 0;             ///< 0: one per core
  uint64_t memory = 0;         ///< budget in bytes for values and running nodes; 0: the process's, see memory_budget
  bool checked =
      false;  ///< each node twice, and watched, see runner/engine/checked.h; with one thread and without a cache
  const std::atomic<bool>* cancelled = nullptr;  ///< set it to stop the run; may be null
  RunObserver* observer = nullptr;
  const Sandbox* sandbox = nullptr;  ///< keeps nodes from files elsewhere; may be null
};

/// An activity of a worker, for `write_trace`; times in seconds since the start of the run.
struct Span {
  std::string what;  ///< "run", "wait", "load", "store", "look up"
  int stage = 0;
  int thread = 0;
  double start = 0, end = 0;
};

struct StageOutcome {
  enum class Kind : uint8_t {
    idle,        ///< not needed, or lazy and never read
    reused,      ///< its result was cached
    run,         ///< it was computed
    failed,      ///< it threw
    unfinished,  ///< the run ended before it
    skipped,     ///< a node that it needs failed
  };
  Kind kind = Kind::idle;
  std::string node;
  std::string reason;                     ///< why it had to run, if the plan could not know yet
  double seconds = 0;                     ///< computing time in this run
  std::vector<std::string> notes;         ///< from this run, or from when its result was computed
  std::vector<OutputFile> files;          ///< written by a sink, in this run or before
  std::string because;                    ///< of a skipped stage: the node whose failure it is due to
  std::optional<Digest> key;              ///< once it is known
  std::map<std::string, Digest> outputs;  ///< the names of its values, once they are known
};

struct Failure {
  std::string node;
  std::string message;  ///< complete: graph file, place, node, port or parameter, and what is wrong
};

struct RunResult {
  bool cancelled = false;
  std::vector<Failure> failures;
  std::vector<StageOutcome> stages;                          ///< one per node, in the graph's order
  std::map<std::string, std::map<std::string, Value>> kept;  ///< of `targets.keep`: values by node and output port
  std::vector<Span> spans;
  double seconds = 0;
  uint64_t memory = 0;  ///< the most bytes that were counted against the budget at a time

  bool ok() const { return !cancelled && failures.empty(); }
  int count(StageOutcome::Kind kind) const;
  /// "8 stages: 5 cached, 3 run, 1.84 s".
  std::string summary() const;
  /// A line for each failed node that others needed: which ones were skipped because of it.
  std::vector<std::string> skips() const;
};

/// Plans the graph and runs what must run. Independent nodes run in parallel; values are freed after their last reader.
/// The first failure ends the run once running nodes have finished; with `targets.keep_going`, all runs that does not
/// need a failed node. Failures and cancellation are in the result; only make_plan throws.
RunResult run_graph(const Graph& graph, const RunOptions& options);

/// Runs a plan made with the same targets, cache and history.
RunResult run_plan(Plan plan, const RunOptions& options);

}  // namespace terrazzo
