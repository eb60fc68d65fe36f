#pragma once

#include <vector>

#include "graphs/document/problem.h"
#include "runner/plan.h"

namespace terrazzo {

/// What would surely go wrong in the stages that are needed: sources that are not there, folders that cannot be
/// written, two sinks that write one file. Stages whose files are up to date write none.
std::vector<Problem> foreseen_problems(const Plan& plan);

}  // namespace terrazzo
