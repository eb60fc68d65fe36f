#pragma once

#include <string>

#include "core/node/node.h"

namespace terrazzo {

/// What is wrong with a descriptor that is to be registered; empty if nothing is.
std::string fault_of_node_type(const NodeType& type);

}  // namespace terrazzo
