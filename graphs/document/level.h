#pragma once

#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "graphs/document/loops.h"
#include "graphs/document/nodes.h"
#include "graphs/document/subgraphs.h"

/// The nodes of a graph with those of its subgraphs: a tree of levels. Each level has parameters and names of its own.
namespace terrazzo {

/// Parameters as expressions see them: those of a level, or, in a round of a loop, the loop's variables before these.
struct NodeScope {
  std::vector<GraphParameter> parameters;  ///< of a round only the variables
  std::unique_ptr<GraphScope> scope;
  std::unique_ptr<Substitution> substitution;
};

/// What a name in a level's section `nodes` stands for; several in a loop.
struct NodeInstance {
  NodeDraft* draft = nullptr;
  Level* inner = nullptr;  ///< null if it is no graph, is muted, or could not be read
};

/// A graph that is being read: the document, or one use of a subgraph.
struct Level {
  const Subgraph* graph = nullptr;
  Level* outer = nullptr;
  NodeDraft* use = nullptr;  ///< the node in `outer` that it is
  std::string path;          ///< begins the names of its nodes: "walls/"
  NodeScope names;
  std::vector<std::unique_ptr<NodeScope>> rounds;  ///< of all its loops
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
