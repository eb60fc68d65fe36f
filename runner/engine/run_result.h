#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/node/value.h"
#include "runner/cache/stage_record.h"

namespace terrazzo {

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
    unfinished,  ///< the run ended before the stage
    skipped,     ///< a node that it needs failed
  };
  Kind kind = Kind::idle;
  std::string node;
  std::string reason;                     ///< why it had to run, if the plan did not know yet
  double seconds = 0;                     ///< computing time in this run
  std::vector<std::string> notes;         ///< from this run, or from the run that computed its result
  std::vector<OutputFile> files;          ///< written by a sink, in this run or before
  std::string because;                    ///< for a skipped stage: the node whose failure caused it
  std::optional<Digest> key;              ///< once it is known
  std::map<std::string, Digest> outputs;  ///< the names of its values, once they are known
};

struct Failure {
  std::string node;
  std::string message;  ///< complete: graph file, place, node, port or parameter, and error
};

struct RunResult {
  bool cancelled = false;
  std::vector<Failure> failures;
  std::vector<StageOutcome> stages;                          ///< one per node, in the graph's order
  std::map<std::string, std::map<std::string, Value>> kept;  ///< of `targets.keep`: values by node and output port
  std::vector<Span> spans;
  double seconds = 0;
  uint64_t memory = 0;  ///< peak bytes counted against the budget

  bool ok() const { return !cancelled && failures.empty(); }
  int count(StageOutcome::Kind kind) const;
  /// "8 stages: 5 cached, 3 run, 1.84 s".
  std::string summary() const;
  /// One line per failed node that lists the nodes skipped because of it.
  std::vector<std::string> skips() const;
};

}  // namespace terrazzo
