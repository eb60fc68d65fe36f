#pragma once

#include <string_view>
#include <vector>

#include "core/node/node.h"

namespace terrazzo {

/// All node types: those of terrazzo in the order of node_list.inc, then those that were registered. Thread-safe; what
/// was returned stays as it is, and descriptors live as long as the program.
const std::vector<NodeType>& node_types();
/// Null if there is no such type.
const NodeType* find_node_type(std::string_view name);

/// Makes a node type known to all graphs that are loaded from now on. A type of the same name and the same origin is
/// replaced for them. `origin` tells where it comes from: it is part of the keys of its results, so that two plug-ins,
/// or two builds of one, never take each other's. Throws Error if the descriptor is incomplete, or if the name is taken
/// by a type of terrazzo or of another origin. Thread-safe.
void register_node_type(NodeType type);

}  // namespace terrazzo
