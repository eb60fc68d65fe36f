#pragma once

#include <string_view>
#include <vector>

#include "core/node/node.h"

namespace terrazzo {

/// All node types, in the order of node_list.inc. Thread-safe; descriptors live as long as the program.
const std::vector<NodeType>& node_types();
/// Null if there is no such type.
const NodeType* find_node_type(std::string_view name);

}  // namespace terrazzo
