#pragma once

#include <string>
#include <utility>
#include <vector>

#include "runner/engine/run_result.h"
#include "runner/plan/plan.h"

namespace terrazzo {

/// Notes, by stage index, on maps of another run that lie beside those written in this one and match their naming:
/// reading the folder as a material would mix the two. Ignores files that the graph reads or writes elsewhere. None if
/// parts of the graph did not run.
std::vector<std::pair<int, std::string>> notes_on_stale_outputs(const Plan& plan,
                                                                const std::vector<StageOutcome>& outcomes);

}  // namespace terrazzo
