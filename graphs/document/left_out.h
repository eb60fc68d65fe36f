#pragma once

#include <set>
#include <string>
#include <vector>

#include "graphs/document/nodes.h"

namespace terrazzo {

/// Whether all parameters and wires of the node have been read.
bool is_complete(const NodeDraft& draft);

/// The wanted nodes that can run although the sources `faulty` cannot be read, plus these sources. A node cannot run if
/// its parameters depend on the results of a faulty source, or if it reads such a node. `order` is topological.
std::set<std::string> nodes_left(const Drafts& drafts, const std::vector<size_t>& order,
                                 const std::set<std::string>& wanted, const std::set<std::string>& faulty);

}  // namespace terrazzo
