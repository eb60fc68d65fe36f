#pragma once

#include <string>
#include <vector>

#include "core/node/node.h"
#include "nodes/common/registry.h"

namespace terrazzo {

/// A JSON Schema (draft 2020-12) of graph documents, made from the descriptors: editors complete and check by it. It
/// accepts every valid document but knows nothing of what joins nodes; comments are beyond JSON Schema.
std::string json_schema(const std::vector<NodeType>& types = node_types());

}  // namespace terrazzo
