#pragma once

#include <deque>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "core/node/node.h"
#include "graphs/document/nodes.h"
#include "graphs/text/json.h"
#include "graphs/text/migrate.h"
#include "graphs/text/stock_graphs.h"
#include "graphs/values/parameters.h"

/// Graphs used as node types: a file ("walls.json"), an entry of the section `graphs` of the same file ("walls"), or a
/// graph that comes with the program ("stock:material").
namespace terrazzo {

/// An output of a graph: {"from": "@node.port", "type": "image", "help": "..."}, or just the wire.
struct GraphOutput {
  Port port;
  JsonValue from;
};

/// A graph that can be used as a node. Its nodes are not read yet.
struct Subgraph {
  std::string title{};  ///< as spelled in the document
  std::string file{};   ///< file of its text, for messages; empty: the main document
  std::filesystem::path folder{};
  const JsonValue* json = nullptr;         ///< with `nodes`, `parameters`, ...
  const Subgraph* document = nullptr;      ///< the document whose section `graphs` it can use
  std::vector<std::string> graph_names{};  ///< names in its section `graphs`
  std::string summary{}, help{};
  std::vector<GraphParameter> parameters{};
  std::vector<Port> inputs{};
  std::vector<GraphOutput> outputs{};
  bool is_wrong = false;  ///< a problem with an output has been reported: wires from it are not checked

  /// The possible sources of its wires: its nodes, with a null type if that is unknown or invalid, and its inputs.
  NodeTypes sources{};
  std::map<std::string, size_t> positions{};  ///< in `sources`
  std::deque<NodeType> types{};               ///< types of nodes that are graphs, and of inputs

  /// Null if there is none of that name.
  const NodeTypes::value_type* find_source(const std::string& name) const {
    const auto at = positions.find(name);
    return at == positions.end() ? nullptr : &sources[at->second];
  }
};

/// The category of graphs used as node types.
inline constexpr std::string_view graph_category = "graph";

/// The keys of a document, and of an entry of its section `graphs`.
const std::vector<std::string>& document_keys();
const std::vector<std::string>& subgraph_keys();

/// Finds graphs and reads each once. Not thread-safe.
class Subgraphs {
 public:
  Subgraphs(const KnownTypes& types, const std::vector<Migration>& migrations, std::vector<Problem>& problems)
      : types_(types), migrations_(migrations), problems_(problems) {}

  /// The document itself, which must outlive this; `file` is absolute.
  Subgraph& read_main(const JsonValue& document, const std::filesystem::path& file);

  /// The graph that `type` of a node in `from` names; null if it names none, or after a problem.
  const Subgraph* find(const JsonValue& type, const Subgraph& from);
  /// Whether a type names a graph file or a stock graph.
  static bool is_file(std::string_view type) { return type.ends_with(".json") || is_stock(type); }

  /// The files that have been read, and the unused names of the section `graphs`.
  std::vector<std::filesystem::path> files() const;
  std::vector<std::pair<std::string, Place>> unused() const;

 private:
  const Subgraph* read(const std::string& key, Subgraph graph);
  void read_sections(Subgraph& graph);
  void read_inputs(Subgraph& graph, const JsonValue& section);
  void read_sources(Subgraph& graph);
  void read_output(Subgraph& graph, const JsonMember& member);
  const Port* port_behind(const Subgraph& graph, const JsonValue& wire) const;
  const JsonValue* document_in(std::string_view text, const std::string& file);
  std::string text_at(const JsonValue& json, std::string_view key);

  const KnownTypes& types_;
  const std::vector<Migration>& migrations_;
  std::vector<Problem>& problems_;
  std::deque<JsonValue> documents_;
  std::deque<Subgraph> graphs_;
  std::map<std::string, Subgraph*> by_key_;
  std::vector<const Subgraph*> open_;  ///< currently being read
  std::vector<std::filesystem::path> files_;
};

/// The node type of this graph: its inputs, outputs and parameters. A type cannot hold defaults that are expressions:
/// such parameters are included only if `given` contains them.
NodeType type_of_use(const Subgraph& graph, const std::vector<std::string>& given);

}  // namespace terrazzo
