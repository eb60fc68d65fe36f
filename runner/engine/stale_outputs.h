#pragma once

#include <string>
#include <utility>
#include <vector>

#include "runner/engine/run_result.h"
#include "runner/plan/plan.h"

namespace terrazzo {

/// Notes, by stage index, on maps of an earlier run that are in the same folder as maps of this run and match their
/// naming: reading the folder as a material would mix the two. Ignores files that other nodes of the graph read or
/// write. Empty if parts of the graph did not run.
std::vector<std::pair<int, std::string>> notes_on_stale_outputs(const Plan& plan,
                                                                const std::vector<StageOutcome>& outcomes);

}  // namespace terrazzo
