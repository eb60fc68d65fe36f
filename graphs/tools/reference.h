#pragma once

#include <string>
#include <vector>

#include "core/node/node.h"
#include "graphs/document/load.h"
#include "nodes/common/registry.h"

/// The reference of node types, generated from their descriptors.
namespace terrazzo {

/// The documentation of one node type: summary, help, ports, and parameters with type, range, unit, choices and
/// default; at most 80 columns wide.
std::string node_reference(const NodeType& type);

/// The documentation of a graph for its users: summary, help, its parameters by group, and its presets.
std::string graph_reference(const std::string& name, const GraphInterface& graph);

/// All node types by category, one line each.
std::string node_list(const std::vector<NodeType>& types = node_types());

/// All descriptors as a JSON array, for programs.
std::string nodes_json(const std::vector<NodeType>& types = node_types());

}  // namespace terrazzo
