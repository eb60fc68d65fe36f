#pragma once

#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "graphs/document/loops.h"
#include "graphs/document/nodes.h"
#include "graphs/document/subgraphs.h"

/// The nodes of a graph and its subgraphs as a tree of levels. Each level has its own parameters and names.
namespace terrazzo {

/// The parameters visible to expressions: those of a level or, in an iteration of a loop, the loop's variables first.
struct NodeScope {
  std::vector<GraphParameter> parameters;  ///< in an iteration only the loop's variables
  std::unique_ptr<GraphScope> scope;
  std::unique_ptr<Substitution> substitution;
};

/// The instance of a name in a level's section `nodes`; a loop has several.
struct NodeInstance {
  NodeDraft* draft = nullptr;
  Level* inner = nullptr;  ///< null if the node is no graph, is muted, or could not be read
};

/// A graph being read: the document, or one use of a subgraph.
struct Level {
  const Subgraph* graph = nullptr;
  Level* outer = nullptr;
  NodeDraft* use = nullptr;  ///< its node in `outer`
  std::string path;          ///< prefix of its nodes' names: "walls/"
  NodeScope names;
  std::vector<std::unique_ptr<NodeScope>> iterations;  ///< the iterations of all its loops
  NodeReading reading;
  std::vector<std::pair<std::string, std::vector<NodeInstance>>> items;  ///< by name, in the document's order
  std::map<std::string, size_t> positions;                               ///< in `items`
  std::map<std::string, PortWires> outputs;

  const PortWires* find_output(const std::string& name) const {
    const auto at = outputs.find(name);
    return at == outputs.end() ? nullptr : &at->second;
  }
  const std::vector<NodeInstance>* find(const std::string& name) const {
    const auto at = positions.find(name);
    return at == positions.end() ? nullptr : &items[at->second].second;
  }
};

}  // namespace terrazzo
