#pragma once

#include <vector>

#include "graphs/document/levels.h"

namespace terrazzo {

/// Warnings about a document that has been read: parameters and graphs that no node uses, nodes that no sink reads, and
/// a graph without sinks. `order` has the nodes that run, in topological order.
std::vector<Problem> warnings_about(const Levels& levels, const Subgraphs& subgraphs, const Level& root,
                                    const std::vector<size_t>& order);

}  // namespace terrazzo
