#pragma once

#include <vector>

#include "core/base/task.h"
#include "graphs/text/graph.h"
#include "graphs/text/problem.h"

namespace terrazzo {

struct SourceFindings {
  std::vector<Problem> errors;    ///< errors thrown by the nodes
  std::vector<Problem> warnings;  ///< their warnings
};

/// Runs all source nodes that read files and have no inputs, collects their errors and warnings, and discards their
/// results. Throws Cancelled.
SourceFindings look_at_sources(const Graph& graph, const Task& task);

}  // namespace terrazzo
