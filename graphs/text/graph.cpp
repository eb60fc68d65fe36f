#include "graphs/text/graph.h"

#include <algorithm>

namespace terrazzo {

bool stands_for(std::string_view name, std::string_view node) {
  return node.starts_with(name) && (node.size() == name.size() || node[name.size()] == '/' || node[name.size()] == '[');
}

std::vector<std::string> nodes_meant(const Graph& graph, const std::vector<std::string>& names) {
  std::vector<std::string> out;
  for (const GraphNode& n : graph.nodes)
    if (std::ranges::any_of(names, [&](const std::string& name) { return stands_for(name, n.name); }))
      out.push_back(n.name);
  for (const std::string& name : names)
    if (std::ranges::none_of(graph.nodes, [&](const GraphNode& n) { return stands_for(name, n.name); }))
      out.push_back(name);
  return out;
}

}  // namespace terrazzo
