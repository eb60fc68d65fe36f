#pragma once

#include <vector>

#include "graphs/document/levels.h"

namespace terrazzo {

/// Warns about parameters and graphs that no node uses, nodes that no sink reads, and graphs without sinks. `order`
/// lists the nodes that run in topological order.
std::vector<Problem> warnings_about(const Levels& levels, const Subgraphs& subgraphs, const Level& root,
                                    const std::vector<size_t>& order);

}  // namespace terrazzo
