#pragma once

#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "core/node/node.h"

/// A graph that has been read, expanded and checked: everything that the runner needs, independent of JSON.
namespace terrazzo {

/// A position in a document; 1-based, 0 = none (for values from the command line).
struct Place {
  int line = 0;
  int column = 0;
};

/// The end of a wire: an output of another node. The value is converted to the input port's type (see `converts`).
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
  std::string comment{};                            ///< what the document says about it; for reports and drawings
  Place place{};
  /// Of the parameters and ports that the document gives; "weights.height" of a member of a map, "maps.0" of an item
  /// of a list.
  std::map<std::string, Place> places{};
  std::string file{};    ///< that the places are in; empty: the graph's own
  bool is_open = false;  ///< it needs something that has not been set: it can be looked at, but not run
  bool fails = false;    ///< certainly: what is made from what it gives has been left out of the graph
  /// Of path parameters and of ports: the graph's own parameters that say which files they, or what comes in, are from.
  std::map<std::string, std::set<std::string>> files_by{};

  /// Of the parameter, port or part of one, or of the nearest around it that the document gives.
  Place place_of(const std::string& about) const {
    const auto at = places.find(about);
    if (at != places.end() && at->second.line > 0) return at->second;
    const size_t dot = about.rfind('.');
    return dot == about.npos ? place : place_of(about.substr(0, dot));
  }
};

/// A parameter of the graph as it was set, for reports.
struct GraphSetting {
  std::string name;
  ParamValue value;
  std::string help{};
  bool given = false;  ///< by the command line, a preset or a settings file; else it is the document's default
};

struct Graph {
  std::filesystem::path file;  ///< for messages; may be empty for graphs made in memory
  std::string summary;
  std::vector<GraphNode> nodes;  ///< in topological order: every wire comes from an earlier node
  /// What else it was made from: subgraphs, tables, and folders that were listed.
  std::vector<std::filesystem::path> made_from{};
  std::vector<GraphSetting> settings{};  ///< in the document's order; only parameters that have a value

  const GraphNode* find(std::string_view name) const {
    for (const GraphNode& n : nodes)
      if (n.name == name) return &n;
    return nullptr;
  }
};

/// Whether a name stands for the node: its own, that of a subgraph it is in ("walls" for "walls/layout"), or that of
/// all rounds of a loop ("walls" for "walls[brick]").
bool stands_for(std::string_view name, std::string_view node);
/// The nodes that these names stand for, in the graph's order; names that stand for none are kept, for messages.
std::vector<std::string> nodes_meant(const Graph& graph, const std::vector<std::string>& names);

}  // namespace terrazzo
