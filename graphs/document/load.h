#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "graphs/document/loops.h"
#include "graphs/text/graph.h"
#include "graphs/text/migrate.h"
#include "graphs/text/problem.h"
#include "graphs/values/parameters.h"
#include "graphs/values/presets.h"
#include "nodes/common/registry.h"

/// From a graph document to a checked graph. Thread-safe.
namespace terrazzo {

struct LoadOptions {
  /// Node types that the document may use; they must outlive the graph.
  const std::vector<NodeType>& types = node_types();
  const std::vector<Migration>& migrations = document_migrations();
  /// Presets by name, then settings files (see read_settings); each counts more than those before it, and overrides
  /// count more than all of them.
  std::vector<std::string> presets{};
  std::vector<std::filesystem::path> settings{};
  /// Parameters without a default may be unset. Nodes that depend on them are then missing: such a graph can be
  /// inspected, but not run.
  bool allow_unset = false;
  /// Unless empty, and if all exist: only these nodes and their sources will run, and only parameters that these need
  /// must be set. If others are unset, or their sources cannot be read, the graph has only these nodes.
  std::vector<std::string> only{};
  /// What is wrong with a source that others are made from only leaves those out that ask for it; the source stays,
  /// with GraphNode::fails.
  bool keep_going = false;
  /// Node types that give values to inputs that the graph declares, by the inputs' names; they must outlive the graph.
  /// Other names are left alone: LoadedGraph::given tells which were used.
  std::map<std::string, const NodeType*> inputs{};
  /// If a document has problems: finds more in its valid nodes, so that all are reported at once. Gets the nodes in
  /// topological order, as far as there is one.
  std::function<std::vector<Problem>(const std::vector<GraphNode>&)> look_ahead{};
  /// Of a graph that comes from a pack: where that is unpacked. What it says about its inputs counts less than anything
  /// else. Sinks may write into the folder of `path`; elsewhere only where overrides and settings files say so.
  std::filesystem::path pack{};
  bool traces = false;  ///< tells LoadedGraph::set_by
};

struct LoadedGraph {
  Graph graph;
  std::string help;
  std::vector<GraphParameter> parameters;
  std::vector<Preset> presets;
  std::vector<Port> inputs;  ///< of a graph that is made to be a node of others
  std::vector<LoopSource> loops;
  std::map<std::string, SetBy> set_by{};  ///< by node, if LoadOptions::traces
  std::vector<std::string> given;         ///< of LoadOptions::inputs, those that the graph declares
  /// Images that become materials of one map; nodes and parameters that nothing uses.
  std::vector<Problem> conversions, warnings;
};

/// Reads a document. `overrides` are `name=value` for a parameter of the graph and `node.parameter=value` (a wire into
/// a port likewise); of several for one target the last counts. Relative paths lie in the graph file's folder, those of
/// overrides in the working directory. Throws GraphError with all problems, and nothing else.
LoadedGraph load_graph(const std::filesystem::path& path, const std::vector<std::string>& overrides = {},
                       const LoadOptions& options = {});

/// The same for text that has been read already; `path` is for messages and relative paths, and need not exist.
LoadedGraph load_graph_text(std::string_view text, const std::filesystem::path& path,
                            const std::vector<std::string>& overrides = {}, const LoadOptions& options = {});

/// Summary and parameters of a graph.
struct GraphInterface {
  std::string summary;
  std::string help;
  std::vector<GraphParameter> parameters;
  std::vector<Preset> presets;
  std::vector<Port> inputs, outputs;
};

/// Reads summary and parameters; nodes are not looked at. Throws GraphError.
GraphInterface read_interface(const std::filesystem::path& path);
GraphInterface read_interface_text(std::string_view text, const std::filesystem::path& path);

}  // namespace terrazzo
