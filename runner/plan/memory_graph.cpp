#include "runner/plan/memory_graph.h"

#include <stdexcept>

#include "core/material/material_files.h"
#include "graphs/values/convert.h"
#include "nodes/common/registry.h"

namespace terrazzo {

namespace fs = std::filesystem;

GraphNode memory_node(const std::string& name, const std::string& type, const Params& given) {
  GraphNode node;
  node.name = name;
  node.type = find_node_type(type);
  if (!node.type) throw std::logic_error("there is no node type " + type);
  node.params = given;
  for (const Param& p : node.type->params) {
    if (node.params.count(p.name)) continue;
    if (!p.fallback) throw std::logic_error(type + " needs the parameter " + p.name);
    node.params[p.name] = default_of(p, fs::current_path());
  }
  return node;
}

GraphNode reading_node(const std::string& name, const fs::path& path) {
  const fs::path absolute = fs::absolute(path).lexically_normal();
  if (fs::is_directory(absolute)) return memory_node(name, "load_material", {{"path", absolute.string()}});
  const std::vector<RecognisedMap> maps = recognise_map({.name = absolute.filename().string(), .size = {}});
  const Semantic semantic = maps.size() == 1 ? maps.front().semantic : Semantic::base_color;
  return memory_node(name, "load_map", {{"path", absolute.string()}, {"semantic", std::string(name_of(semantic))}});
}

}  // namespace terrazzo
