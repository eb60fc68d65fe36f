#pragma once

#include <vector>

#include "graphs/values/override.h"
#include "graphs/values/parameters.h"

namespace terrazzo {

/// Makes "weights.height=2" the whole map, where `weights` is no node but a parameter of the graph.
void merge_members(std::vector<Override>& overrides, const std::vector<GraphParameter>& parameters,
                   const NodeTypes& nodes, std::vector<Problem>& problems);

}  // namespace terrazzo
