#pragma once

#include <set>
#include <string>
#include <vector>

#include "graphs/document/nodes.h"

namespace terrazzo {

/// Whether all parameters and wires of the node have been read.
bool is_complete(const NodeDraft& draft);

/// Of the nodes that are wanted, those that can be made although the sources `faulty` cannot be read, and these sources
/// themselves. What cannot be made has parameters that are made from what a faulty source gives, or reads such a node.
/// `order` is topological.
std::set<std::string> nodes_left(const Drafts& drafts, const std::vector<size_t>& order,
                                 const std::set<std::string>& wanted, const std::set<std::string>& faulty);

}  // namespace terrazzo
