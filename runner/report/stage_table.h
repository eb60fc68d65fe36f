#pragma once

#include <string>
#include <vector>

#include "runner/engine/schedule.h"

namespace terrazzo {

/// The outcome and reason of each node as an HTML table. If there are many, nodes that belong to one variation, loop or
/// subgraph are collapsed under a line with their number, unless one has failed.
std::string stage_table(const Plan& plan, const RunResult& result);

/// Notes, or only warnings, each with its node. Equal notes of several nodes are merged.
std::vector<std::string> notes_html(const RunResult& result, bool only_warnings);

}  // namespace terrazzo
