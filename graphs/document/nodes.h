#pragma once

#include <deque>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "graphs/document/loops.h"
#include "graphs/text/graph.h"
#include "graphs/text/json.h"
#include "graphs/values/override.h"
#include "graphs/values/substitution.h"

/// The nodes of a graph, each by itself. Wires are in wires.h, the graphs that nodes may be in level.h.
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
  bool has_faults = false;  ///< not all of its wires could be read
};

/// One key of a node, from the document or, if `by` is set, from the command line.
struct NodeEntry {
  std::string name;
  Place place;
  const JsonValue* value = nullptr;
  const Override* by = nullptr;
  std::shared_ptr<JsonValue> merged{};  ///< a map in which an override has set one member; instead of both
};

struct Level;
struct NodeReading;

/// A node read and checked, but for its wires.
struct NodeDraft {
  std::string local;  ///< its name in its graph; `node.name` has the path before it
  GraphNode node;     ///< `type` is null if it is unknown; `inputs` are still empty
  std::vector<PortWires> ports;
  std::set<std::string> unset;       ///< the graph's parameters that it needs and that have no value
  std::set<std::string> asked;       ///< nodes whose forecasts its parameters are made from, with their paths
  std::vector<NodeEntry> waiting{};  ///< parameters that are made from them, not read yet
  bool muted = false;                ///< it does not run; its input passes through
  std::set<std::string> named{};     ///< nodes of its graph that expressions in its ports name, chosen or not
  Level* level = nullptr;            ///< the graph, or use of a subgraph, that it stands in
  const NodeReading* reading = nullptr;
  Substitution* substitution = nullptr;
  std::map<std::string, std::set<std::string>> names_by{};  ///< of its parameters: the graph's that they name
  SetBy set_by{};                                           ///< if it is asked for, see trace_settables
  std::set<std::string> loop_names{};                       ///< of a round: those that say over what its loop goes
};
/// Their addresses stay.
using Drafts = std::deque<NodeDraft>;

/// Node types by name.
struct KnownTypes {
  explicit KnownTypes(const std::vector<NodeType>& known);
  const NodeType* find(std::string_view name) const;
  std::map<std::string, const NodeType*, std::less<>> types;
  std::vector<std::string> names;
};

/// Context for reading the nodes of one graph.
struct NodeReading {
  const KnownTypes* known = nullptr;
  const std::vector<std::string>* graph_names = nullptr;  ///< that are types too
  std::filesystem::path graph_folder;                     ///< absolute
  std::optional<int64_t> seed;  ///< of the graph; nodes that give no seed derive theirs from it and their name
  std::string seed_path;        ///< before their names, where the seed is that of a graph further out
};

/// What every node may have, whatever its type: "comment", "foreach", "mute", "type".
const std::vector<std::string>& common_node_keys();

/// Reads a node, which must outlive the draft, as must the overrides, which replace what its entries say. The draft
/// comes with its names, level, reading and substitution; with its type if that is a graph.
void read_node(NodeDraft& draft, const JsonValue& value, const std::vector<const Override*>& overrides,
               std::vector<Problem>& problems);

/// Reads what waits for forecasts, once these are known.
void read_waiting(NodeDraft& draft, std::vector<Problem>& problems);

/// Whether a text in a document is a wire: it begins with one "@".
bool is_wire(const JsonValue& value);
/// The two parts of "@node.port"; the second is empty for "@node".
std::pair<std::string, std::string> wire_parts(const std::string& text);
/// The wire that a text is. A dot without an output behind it is a problem.
WireEnd wire_end(const JsonValue& text, Diagnostics& diagnostics);
/// The wire, or list of wires, that `given` stands for, where it may be an expression; `named` gets the nodes it names.
/// Empty after a problem, or if something is lacking.
std::optional<JsonValue> expand_wires(const JsonValue& given, Substitution& substitution, Diagnostics& diagnostics,
                                      std::set<std::string>& named, std::set<std::string>& unset);

}  // namespace terrazzo
