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

/// Loads a graph document as a checked graph. Thread-safe.
namespace terrazzo {

struct LoadOptions {
  /// Node types that the document may use; they must outlive the graph.
  const std::vector<NodeType>& types = node_types();
  const std::vector<Migration>& migrations = document_migrations();
  /// Presets by name, then settings files (see read_settings). Later ones take precedence, and overrides take
  /// precedence over all of them.
  std::vector<std::string> presets{};
  std::vector<std::filesystem::path> settings{};
  /// Allows parameters without a value. Nodes that depend on them are left open: the graph can be inspected, but not
  /// run.
  bool allow_unset = false;
  /// If not empty, and all names exist: only these nodes and their sources will run, and only the parameters they need
  /// must be set. If other parameters are unset, or other sources cannot be read, the graph contains only these nodes.
  std::vector<std::string> only{};
  /// If a source whose results expressions query is faulty, leaves out only the nodes that depend on them. The source
  /// stays, with GraphNode::fails set.
  bool keep_going = false;
  /// Node types that supply the graph's declared inputs, by input name; they must outlive the graph. Unknown names are
  /// ignored: LoadedGraph::given lists the used ones.
  std::map<std::string, const NodeType*> inputs{};
  /// If a document has problems: finds further ones in its valid nodes, so that all are reported at once. Gets the
  /// nodes in topological order, unless there are cycles.
  std::function<std::vector<Problem>(const std::vector<GraphNode>&)> look_ahead{};
  /// For a graph from a pack: the folder where it is unpacked. The pack's own settings have the lowest precedence.
  /// Sinks may write only into the folder of `path` and to paths set by overrides and settings files.
  std::filesystem::path pack{};
  bool traces = false;  ///< fills LoadedGraph::set_by
};

struct LoadedGraph {
  Graph graph;
  std::string help;
  std::vector<GraphParameter> parameters;
  std::vector<Preset> presets;
  std::vector<Port> inputs;  ///< declared inputs, for use as a node of other graphs
  std::vector<LoopSource> loops;
  std::map<std::string, SetBy> set_by{};  ///< by node, if LoadOptions::traces
  std::vector<std::string> given;         ///< the names in LoadOptions::inputs that the graph declares
  /// Implicit conversions from image to material; nodes and parameters that nothing uses.
  std::vector<Problem> conversions, warnings;
};

/// Reads a document. `overrides` set parameters of the graph, and parameters or ports of nodes; the last one for a
/// target wins. Relative paths in the document start at its folder, those in overrides at the working directory. Throws
/// only GraphError, with all problems.
LoadedGraph load_graph(const std::filesystem::path& path, const std::vector<Override>& overrides = {},
                       const LoadOptions& options = {});

/// The same for text in memory; `path` is for messages and relative paths, and need not exist.
LoadedGraph load_graph_text(std::string_view text, const std::filesystem::path& path,
                            const std::vector<Override>& overrides = {}, const LoadOptions& options = {});

/// What can be said of a document, be it valid or not.
struct InspectedGraph {
  std::vector<Problem> problems;  ///< empty: it is valid
  std::vector<Problem> conversions, warnings;
  std::vector<GraphParameter> parameters;  ///< only if it is valid
  /// The values of nodes' parameters, by node; also of nodes that are graphs or muted, and as far as they could be
  /// read.
  std::map<std::string, Params> values;
};

/// As load_graph_text, but never throws because of the document.
InspectedGraph inspect_graph_text(std::string_view text, const std::filesystem::path& path,
                                  const LoadOptions& options = {});

/// The interface of a graph as a document or as a node.
struct GraphInterface {
  std::string summary;
  std::string help;
  std::vector<GraphParameter> parameters;
  std::vector<Preset> presets;
  std::vector<Port> inputs, outputs;
};

/// Reads only the interface, not the nodes. Throws GraphError.
GraphInterface read_interface(const std::filesystem::path& path);
GraphInterface read_interface_text(std::string_view text, const std::filesystem::path& path);

}  // namespace terrazzo
