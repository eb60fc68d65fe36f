#include "runner/cli/exemplar_look.h"

#include <filesystem>

#include "runner/engine/memory_graph.h"

namespace terrazzo {

Graph looking_graph(const std::string& folder, const std::string& name) {
  Graph graph;
  graph.nodes = {
      memory_node("exemplar", "load_material", {{"path", std::filesystem::absolute(folder).string()}, {"name", name}}),
      memory_node("weighted", "weight", {}), memory_node("lattice", "regularity", {}),
      memory_node("elements", "elements", {})};
  graph.nodes[1].inputs["material"] = {{"exemplar", "material"}};
  graph.nodes[2].inputs["features"] = {{"weighted", "features"}};
  graph.nodes[3].inputs["features"] = {{"lattice", "features"}};
  return graph;
}

}  // namespace terrazzo
