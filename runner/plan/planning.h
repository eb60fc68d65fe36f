#pragma once

#include <string>
#include <vector>

#include "runner/plan/plan.h"

namespace terrazzo {

struct PlanOptions {
  std::vector<std::string> only{};  ///< the targets; empty: every sink, or without sinks every node that nothing reads
  std::vector<std::string> keep{};  ///< more targets, whose values are returned in memory
  bool look_ahead = true;           ///< false: what is certain to fail is no error yet
  /// A failure ends only what depends on it. A node that is certain to fail, such as one whose file is truncated, is
  /// one of those then, see Stage::faults.
  bool keep_going = false;
};

/// Determines what must run: everything if `cache` is null. With `history`, reasons name the first difference from the
/// last run. Throws Error if a name in `options` is not a node, and GraphError with all problems that can be found
/// before anything runs (see runner/plan/preflight.h); with `keep_going`, only with those that are not one node's.
Plan make_plan(const Graph& graph, Cache* cache, const PlanOptions& options = {}, const History* history = nullptr);

}  // namespace terrazzo
