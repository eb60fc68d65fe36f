#pragma once

#include <string>
#include <vector>

#include "core/node/node.h"
#include "nodes/common/registry.h"

namespace terrazzo {

/// A JSON Schema (draft 2020-12) of graph documents, generated from the descriptors, for completion and checks in
/// editors. It accepts every valid document but does not check wires. JSON Schema has no comments.
std::string json_schema(const std::vector<NodeType>& types = node_types());

}  // namespace terrazzo
