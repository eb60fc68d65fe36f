#pragma once

#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "core/node/node.h"

/// A loaded graph, expanded and checked: everything that the runner needs, independent of JSON.
namespace terrazzo {

/// A position in a document, 1-based; 0: none (for values from the command line).
struct Place {
  int line = 0;
  int column = 0;
};

/// A wire, given by the output it comes from. Its value is converted to the input port's type (see `converts`).
struct Wire {
  std::string node;
  std::string port;
  auto operator<=>(const Wire&) const = default;
};

struct GraphNode {
  std::string name;
  const NodeType* type = nullptr;
  Params params;                                    ///< complete and checked; paths absolute
  std::map<std::string, std::vector<Wire>> inputs;  ///< by port; only connected ports
  std::string comment{};                            ///< from the document; for reports and drawings
  Place place{};
  /// Places of the parameters and ports in the document; also of members of maps ("weights.height") and items of lists
  /// ("maps.0").
  std::map<std::string, Place> places{};
  std::string file{};    ///< file of the places; empty: the graph's own
  bool is_open = false;  ///< something it needs is unset: it can be inspected, but not run
  bool fails = false;    ///< it is certain to fail; nodes derived from its results have been left out of the graph
  /// By path parameter and port: the graph's own parameters that the files, or the input's files, come from.
  std::map<std::string, std::set<std::string>> files_by{};

  /// The place of a parameter, port or part of one, or of the innermost enclosing one in the document.
  Place place_of(const std::string& about) const {
    const auto at = places.find(about);
    if (at != places.end() && at->second.line > 0) return at->second;
    const size_t dot = about.rfind('.');
    return dot == about.npos ? place : place_of(about.substr(0, dot));
  }
};

/// The value of a parameter of the graph, for reports.
struct GraphSetting {
  std::string name;
  ParamValue value;
  std::string help{};
  bool given = false;  ///< set by the command line, a preset or a settings file; else the document's default
};

struct Graph {
  std::filesystem::path file;  ///< for messages; may be empty for graphs made in memory
  std::string summary;
  std::vector<GraphNode> nodes;  ///< in topological order: every wire comes from an earlier node
  /// Other sources of the graph: subgraphs, tables, and listed folders.
  std::vector<std::filesystem::path> made_from{};
  std::vector<GraphSetting> settings{};  ///< in the document's order; only parameters with a value

  const GraphNode* find(std::string_view name) const {
    for (const GraphNode& n : nodes)
      if (n.name == name) return &n;
    return nullptr;
  }
};

/// Whether a name refers to the node: its own name, that of an enclosing subgraph ("walls" for "walls/layout"), or that
/// of a loop ("walls" for "walls[brick]").
bool stands_for(std::string_view name, std::string_view node);
/// The nodes that these names refer to, in the graph's order. Unknown names are kept, for messages.
std::vector<std::string> nodes_meant(const Graph& graph, const std::vector<std::string>& names);

}  // namespace terrazzo
