#pragma once

#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "graphs/document/graph.h"
#include "graphs/document/json.h"
#include "graphs/document/override.h"
#include "graphs/document/parameters.h"

/// The section `nodes`: each node by itself; wires are in wires.h.
namespace terrazzo {

/// A wire as a node names it: "@node" or "@node.port".
struct WireEnd {
  std::string node;
  std::string port;  ///< empty for the node's first output
  Place place;
  std::string spelled;
};

/// All wires into one port, in order.
struct PortWires {
  const Port* port = nullptr;
  std::vector<WireEnd> wires;
  Diagnostics diagnostics;
};

/// A node read and checked, but for its wires.
struct NodeDraft {
  GraphNode node;  ///< `type` is null if it is unknown; `inputs` are still empty
  std::vector<PortWires> ports;
  std::set<std::string> unset;  ///< the graph's parameters that it needs and that have no value
};

/// Context for reading nodes.
struct NodeReading {
  explicit NodeReading(const std::vector<NodeType>& known);
  std::map<std::string, const NodeType*, std::less<>> types;
  std::vector<std::string> type_names;
  std::filesystem::path graph_folder;    ///< absolute
  std::filesystem::path working_folder;  ///< absolute
};

/// Reads the section; overrides with a node replace what its entries say.
std::vector<NodeDraft> read_nodes(const JsonValue& section, const std::vector<Override>& overrides,
                                  const NodeReading& reading, Substitution& substitution,
                                  std::vector<Problem>& problems);

}  // namespace terrazzo
