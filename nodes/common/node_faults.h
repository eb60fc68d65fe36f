#pragma once

#include <string>

#include "core/node/node.h"

namespace terrazzo {

/// Why a node type cannot be registered; empty if it can.
std::string fault_of_node_type(const NodeType& type);

}  // namespace terrazzo
