#pragma once

#include <string>
#include <vector>

#include "runner/plan/plan.h"

namespace terrazzo {

struct PlanOptions {
  std::vector<std::string> only{};  ///< the targets; empty: every sink, or without sinks every node that nothing reads
  std::vector<std::string> keep{};  ///< further targets, whose values are returned in memory
  bool look_ahead = true;           ///< false: skips preflight checks
  /// A failure stops only the nodes that depend on it. Preflight errors of single nodes, such as a truncated file, then
  /// go to Stage::faults.
  bool keep_going = false;
};

/// Determines which stages must run: all if `cache` is null. With `history`, reasons name the first difference from the
/// last run. Throws Error if a name in `options` is not a node, and GraphError with all problems found by preflight
/// checks (see runner/plan/preflight.h); with `keep_going` only PreflightProblems::of_run.
Plan make_plan(const Graph& graph, Cache* cache, const PlanOptions& options = {}, const History* history = nullptr);

}  // namespace terrazzo
