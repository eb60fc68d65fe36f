#pragma once

#include <atomic>
#include <chrono>
#include <map>
#include <string>
#include <vector>

#include "runner/engine/plan.h"

namespace terrazzo {

/// Told what a run does. Calls come from any thread, several at once, and must be quick. Of a needed stage comes one of
/// finished, reused, spared and failed, unless the run ends before.
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
  /// It did not have to run: its result, or what its files hold, is what was computed before.
  virtual void reused(const Stage&) {}
  /// Nobody has asked for its result, and there is none.
  virtual void spared(const Stage&) {}
  virtual void failed(const Stage&, const std::string& /*message*/) {}
};

struct RunOptions {
  PlanOptions targets;
  Cache* cache = nullptr;      ///< null: nothing is reused and nothing is kept
  History* history = nullptr;  ///< for the reasons in plans; updated by the run
  int threads = 0;             ///< 0: one per core
  uint64_t memory = 0;         ///< bytes that running nodes may need together; 0: half of the machine's memory
  const std::atomic<bool>* cancelled = nullptr;  ///< set it to stop the run; it may stay null
  RunObserver* observer = nullptr;
};

/// Something a worker did, for `write_trace`; times in seconds since the start of the run.
struct Span {
  std::string what;  ///< "run", "wait", "load", "store", "look up"
  int stage = 0;
  int thread = 0;
  double start = 0, end = 0;
};

struct StageOutcome {
  enum class Kind : uint8_t {
    idle,        ///< not needed, or lazy and never asked for
    reused,      ///< its result was there
    run,         ///< it was computed
    failed,      ///< it threw
    unfinished,  ///< the run ended before it
  };
  Kind kind = Kind::idle;
  std::string node;
  double seconds = 0;              ///< what computing took, this time
  std::vector<std::string> notes;  ///< what it said, this time or when its result was computed
  std::vector<OutputFile> files;   ///< what a sink wrote, this time or before
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

  bool ok() const { return !cancelled && failures.empty(); }
  int count(StageOutcome::Kind kind) const;
  /// "8 stages: 5 cached, 3 run, 1.84 s".
  std::string summary() const;
};

/// Plans the graph and runs what has to be run. Independent nodes run side by side; a node's inputs are let go after
/// its last reader. The first node that fails ends the run once the nodes that are running have finished. Failures and
/// cancellation are in the result; only what keeps a plan from being made is thrown, see make_plan.
RunResult run_graph(const Graph& graph, const RunOptions& options);

/// Runs a plan that was made with the same targets, cache and history.
RunResult run_plan(Plan plan, const RunOptions& options);

}  // namespace terrazzo
