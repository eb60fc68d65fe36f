#pragma once

#include <string_view>
#include <vector>

#include "core/node/node.h"

namespace terrazzo {

/// Every node type, in the order of the registry. Thread-safe; descriptors live as long as the program.
const std::vector<NodeType>& node_types();
/// Null if there is no such type.
const NodeType* find_node_type(std::string_view name);

}  // namespace terrazzo
