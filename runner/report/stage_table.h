#pragma once

#include <string>
#include <vector>

#include "runner/engine/schedule.h"

namespace terrazzo {

/// What each node did and why, as HTML: one table of a few nodes. Of many, those that a variation, a loop or a subgraph
/// has to itself fold under a line that counts them; what failed is open.
std::string stage_table(const Plan& plan, const RunResult& result);

/// Notes, or only warnings, each with the node that it is about. What several nodes say alike stands there once.
std::vector<std::string> notes_html(const RunResult& result, bool only_warnings);

}  // namespace terrazzo
