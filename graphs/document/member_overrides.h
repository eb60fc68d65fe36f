#pragma once

#include <vector>

#include "graphs/values/override.h"
#include "graphs/values/parameters.h"

namespace terrazzo {

/// Turns "weights.height=2" into an override of the whole map if `weights` is a parameter of the graph and not a node.
void merge_members(std::vector<Override>& overrides, const std::vector<GraphParameter>& parameters,
                   const NodeTypes& nodes, std::vector<Problem>& problems);

}  // namespace terrazzo
