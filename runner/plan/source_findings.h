#pragma once

#include <vector>

#include "core/base/task.h"
#include "graphs/text/graph.h"
#include "graphs/text/problem.h"

namespace terrazzo {

struct SourceFindings {
  std::vector<Problem> errors;    ///< what they refuse
  std::vector<Problem> warnings;  ///< what a run would warn of
};

/// What the nodes that read image files find in them: those that have all that they need are run, and what they make is
/// dropped. Throws Cancelled.
SourceFindings look_at_sources(const Graph& graph, const Task& task);

}  // namespace terrazzo
