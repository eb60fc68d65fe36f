#pragma once

#include <vector>

#include "graphs/document/problem.h"
#include "runner/engine/plan.h"

namespace terrazzo {

/// What would surely go wrong in the stages that are needed: sources that are not there, folders that cannot be
/// written, two sinks that write one file. Stages whose files are up to date write none.
std::vector<Problem> preflight_problems(const Plan& plan);

/// The same for nodes of a document that cannot be planned, see LoadOptions.
std::vector<Problem> preflight_of_nodes(const std::vector<GraphNode>& nodes);

}  // namespace terrazzo
