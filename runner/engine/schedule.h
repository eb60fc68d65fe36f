#pragma once

#include "runner/engine/run_options.h"
#include "runner/engine/run_result.h"

namespace terrazzo {

/// Plans the graph, then runs the stages that must run. Independent nodes run in parallel; values are freed after their
/// last reader. The first failure ends the run once running nodes have finished; with `targets.keep_going`, all nodes
/// run that do not need a failed one. The result reports failures and cancellation; only make_plan throws.
RunResult run_graph(const Graph& graph, const RunOptions& options);

/// Runs a plan made with the same targets, cache and history.
RunResult run_plan(Plan plan, const RunOptions& options);

}  // namespace terrazzo
