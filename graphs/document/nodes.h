#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "graphs/document/graph.h"
#include "graphs/document/json.h"
#include "graphs/document/override.h"
#include "graphs/document/substitution.h"

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

/// One key of a node, from the document or, if `by` is set, from the command line.
struct NodeEntry {
  std::string name;
  Place place;
  const JsonValue* value = nullptr;
  const Override* by = nullptr;
  std::shared_ptr<const JsonValue> merged{};  ///< a map in which an override has set one member; instead of both
};

/// A node read and checked, but for its wires.
struct NodeDraft {
  GraphNode node;  ///< `type` is null if it is unknown; `inputs` are still empty
  std::vector<PortWires> ports;
  std::set<std::string> unset;       ///< the graph's parameters that it needs and that have no value
  std::set<std::string> asked;       ///< nodes whose forecasts its parameters are made from
  std::vector<NodeEntry> waiting{};  ///< parameters that are made from them, not read yet
};

/// Context for reading nodes.
struct NodeReading {
  explicit NodeReading(const std::vector<NodeType>& known);
  std::map<std::string, const NodeType*, std::less<>> types;
  std::vector<std::string> type_names;
  std::filesystem::path graph_folder;  ///< absolute
  std::optional<int64_t> seed;         ///< of the graph; nodes that give no seed derive theirs from it and their name
};

/// Reads the section, which must outlive the drafts, as must the overrides: those with a node replace what its entries
/// say.
std::vector<NodeDraft> read_nodes(const JsonValue& section, const std::vector<Override>& overrides,
                                  const NodeReading& reading, Substitution& substitution,
                                  std::vector<Problem>& problems);

/// Reads what waits for forecasts, once these are known.
void read_waiting(NodeDraft& draft, const NodeReading& reading, Substitution& substitution,
                  std::vector<Problem>& problems);

}  // namespace terrazzo
