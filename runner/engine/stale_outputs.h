#pragma once

#include <string>
#include <vector>

#include "runner/engine/schedule.h"

namespace terrazzo {

/// For each stage that wrote maps in this run, by its place in the plan: what to say of maps of the same naming that
/// lie beside them and come from another run, since whoever reads the folder as a material mixes the two. Nothing is
/// said of files that the graph reads or writes elsewhere, and nothing if parts of the graph were left out of the run.
std::vector<std::pair<int, std::string>> notes_on_stale_outputs(const Plan& plan,
                                                                const std::vector<StageOutcome>& outcomes);

}  // namespace terrazzo
