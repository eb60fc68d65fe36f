#pragma once

#include <string_view>
#include <vector>

#include "core/node/node.h"

namespace terrazzo {

/// All node types: the built-in ones in the order of node_list.inc, then registered ones. Thread-safe. Returned lists
/// never change, and descriptors live as long as the program.
const std::vector<NodeType>& node_types();
/// Null if there is no such type.
const NodeType* find_node_type(std::string_view name);

/// Registers a node type for all graphs loaded from now on. Replaces a type of the same name and origin.
/// NodeType::origin is part of the cache keys, so two plug-ins, or two builds of one, never reuse each other's results.
/// Throws Error if the descriptor is incomplete, or if the name belongs to a built-in type or to another origin.
/// Thread-safe.
void register_node_type(NodeType type);

}  // namespace terrazzo
