#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "core/node/node.h"
#include "graphs/document/subgraphs.h"

/// Which parameters of a graph have no effect with the values of now, so that a form may leave them out.
namespace terrazzo {

/// Looks into the graphs that a graph is made of. Not thread-safe; the arguments must outlive it.
class HiddenParameters {
 public:
  /// By path of a node: "walls/layout". Nodes that could not be read are absent.
  using Values = std::map<std::string, const Params*>;

  HiddenParameters(Subgraphs& graphs, const Values& values) : graphs_(graphs), values_(values) {}

  /// Of the document; `parameters` with their values.
  std::set<std::string> of_document(const Subgraph& document, const std::vector<GraphParameter>& parameters) {
    return of(document, parameters, "", 0);
  }
  /// Of a node that is a graph. Empty if its values are not known.
  std::set<std::string> of_node(const std::string& path, const Subgraph& graph) { return of_use(path, graph, 0); }

 private:
  std::set<std::string> of_use(const std::string& path, const Subgraph& graph, int depth);
  /// Those whose "visible_if" says so, and those that are nothing but the value of such a one inside.
  std::set<std::string> of(const Subgraph& graph, const std::vector<GraphParameter>& parameters,
                           const std::string& path, int depth);
  std::set<std::string> of_insides(const Subgraph& graph, const std::string& path, int depth);

  Subgraphs& graphs_;
  const Values& values_;
};

}  // namespace terrazzo
