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

/// Reads the nodes of a graph one by one. Wires are in wires.h, graphs used as nodes in level.h.
namespace terrazzo {

/// A wire as written in a node: "@node" or "@node.port".
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
  bool has_faults = false;  ///< some of its wires could not be read
};

/// One key of a node, from the document or, if `by` is set, from the command line.
struct NodeEntry {
  std::string name;
  Place place;
  const JsonValue* value = nullptr;
  const Override* by = nullptr;
  std::shared_ptr<JsonValue> merged{};  ///< a map with one member set by an override; replaces `value` and `by`
};

struct Level;
struct NodeReading;

/// A node that has been read and checked, except for its wires.
struct NodeDraft {
  std::string local;  ///< its name in its graph; `node.name` is prefixed with the level's path
  GraphNode node;     ///< `type` is null if it is unknown; `inputs` are still empty
  std::vector<PortWires> ports;
  std::set<std::string> unset;       ///< parameters of the graph without a value that it needs
  std::set<std::string> asked;       ///< nodes whose forecasts its parameters query, with their paths
  std::vector<NodeEntry> waiting{};  ///< parameters that query forecasts, not read yet
  bool muted = false;                ///< it does not run; its input passes through
  std::set<std::string> named{};     ///< nodes of its graph named by expressions in its ports, selected or not
  Level* level = nullptr;            ///< the graph, or use of a subgraph, that contains it
  const NodeReading* reading = nullptr;
  Substitution* substitution = nullptr;
  std::map<std::string, std::set<std::string>> names_by{};  ///< by parameter: the graph's parameters that it names
  SetBy set_by{};                                           ///< filled by trace_settables
  std::set<std::string> loop_names{};  ///< in an iteration: the parameters that determine its loop's source
};
/// A deque, so that addresses stay valid.
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
  const std::vector<std::string>* graph_names = nullptr;  ///< graphs that can be used as types
  std::filesystem::path graph_folder;                     ///< absolute
  std::optional<int64_t> seed;  ///< of the graph; nodes without a seed derive theirs from it and their name
  std::string seed_path;        ///< prefix of their names if the seed is that of an enclosing graph
};

/// The keys that every node may have: "comment", "foreach", "mute", "type".
const std::vector<std::string>& common_node_keys();

/// Reads a node. `overrides` replace its entries; both must outlive the draft. The caller sets the draft's names,
/// level, reading and substitution, and its type if that is a graph.
void read_node(NodeDraft& draft, const JsonValue& value, const std::vector<const Override*>& overrides,
               std::vector<Problem>& problems);

/// Reads the parameters in NodeDraft::waiting once their forecasts are known.
void read_waiting(NodeDraft& draft, std::vector<Problem>& problems);

/// Whether a text in a document is a wire: it begins with one "@".
bool is_wire(const JsonValue& value);
/// The two parts of "@node.port"; the second is empty for "@node".
std::pair<std::string, std::string> wire_parts(const std::string& text);
/// Parses a wire. A dot without an output after it is a problem.
WireEnd wire_end(const JsonValue& text, Diagnostics& diagnostics);
/// Evaluates `given`, which may be an expression, to a wire or a list of wires. Adds the nodes it names to `named`, and
/// missing parameters to `unset`. Nullopt after a problem, or if a value is missing.
std::optional<JsonValue> expand_wires(const JsonValue& given, Substitution& substitution, Diagnostics& diagnostics,
                                      std::set<std::string>& named, std::set<std::string>& unset);

}  // namespace terrazzo
