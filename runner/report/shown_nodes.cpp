#include "runner/report/shown_nodes.h"

#include <algorithm>
#include <set>

namespace terrazzo {

namespace {

using Names = std::vector<std::string>;

void add_name(Names& names, const std::string& name) {
  if (std::ranges::find(names, name) == names.end()) names.push_back(name);
}

bool gives(const NodeType& type, std::initializer_list<ValueType> types) {
  return std::ranges::any_of(type.outputs,
                             [&](const Port& p) { return std::ranges::find(types, p.type) != types.end(); });
}

/// A node without inputs that outputs a material or an image.
bool is_source(const GraphNode& node) {
  return node.inputs.empty() && node.type->category == "source" &&
         gives(*node.type, {ValueType::material, ValueType::image});
}

/// Calls `visit` for every direct or indirect source of the node, nearest first; `visit` returns whether to continue
/// behind it.
template <typename Visit>
void for_each_behind(const Graph& graph, const GraphNode& node, const Visit& visit) {
  std::map<std::string, const GraphNode*> nodes;
  for (const GraphNode& n : graph.nodes) nodes.emplace(n.name, &n);
  std::set<std::string> seen;
  std::vector<const GraphNode*> open = {&node};
  for (size_t i = 0; i < open.size(); i++)
    for (const auto& [port, wires] : open[i]->inputs)
      for (const Wire& w : wires) {
        const GraphNode* behind = nodes.at(w.node);
        if (seen.insert(w.node).second && visit(*behind)) open.push_back(behind);
      }
}

/// The exemplars and nearest uv maps among a node's sources.
void add_origins(const Graph& graph, const GraphNode& node, Names& names) {
  for_each_behind(graph, node, [&](const GraphNode& behind) {
    const bool is_uv = gives(*behind.type, {ValueType::uv_map});
    if (is_uv || is_source(behind)) add_name(names, behind.name);
    return !is_uv;
  });
  for_each_behind(graph, node, [&](const GraphNode& behind) {
    if (is_source(behind)) add_name(names, behind.name);
    return true;
  });
}

/// The indexes that the uv maps among these nodes were made from: they know which elements are whole.
void add_indexes(const Graph& graph, Names& names) {
  for (size_t i = 0, count = names.size(); i < count; i++) {
    const GraphNode* node = graph.find(names[i]);
    if (!node || !gives(*node->type, {ValueType::uv_map})) continue;
    if (const auto index = node->inputs.find("index"); index != node->inputs.end())
      add_name(names, index->second.front().node);
  }
}

/// Whether the stage's values are cheap to get in a run that does not need them.
bool is_cheap(const Stage& stage) {
  if (stage.state == StageState::run || stage.state == StageState::depends) return true;
  return stage.type().persist == Persist::payload ? stage.loadable() : stage.sources.empty();
}

/// The value as a material for display; null if it is neither a material nor a base colour.
MaterialPtr as_material(const Value& value) {
  if (const MaterialPtr* m = std::get_if<MaterialPtr>(&value)) return *m;
  const ImagePtr* image = std::get_if<ImagePtr>(&value);
  return image && (*image)->info().semantic == Semantic::base_color ? Material::of(*image) : nullptr;
}

class Materials {
 public:
  Materials(const Graph& graph, const RunResult& result) : graph_(graph), result_(result) {}

  ShownMaterials all() {
    for (const GraphNode& n : graph_.nodes)
      if (n.type->is_sink() && n.type->outputs.empty())
        for (const auto& [port, wires] : n.inputs)
          for (const Wire& w : wires) add(out_.results, w);
    for (const ShownMaterial& result : out_.results)
      for_each_behind(graph_, *graph_.find(result.node), [&](const GraphNode& behind) {
        if (is_source(behind))
          for (const Port& p : behind.type->outputs) add(out_.exemplars, {behind.name, p.name});
        return true;
      });
    return std::move(out_);
  }

 private:
  void add(std::vector<ShownMaterial>& list, const Wire& wire) {
    const auto kept = result_.kept.find(wire.node);
    if (kept == result_.kept.end() || !kept->second.contains(wire.port)) return;
    const MaterialPtr material = as_material(kept->second.at(wire.port));
    if (material && seen_.insert(material->digest().hex()).second) list.push_back({wire.node, material});
  }

  const Graph& graph_;
  const RunResult& result_;
  ShownMaterials out_;
  std::set<std::string> seen_;
};

}  // namespace

Names nodes_for_report(const Graph& graph, const Names& only, Session& session) {
  Names names, origins;
  for (const GraphNode& n : graph.nodes) {
    const auto is_meant = [&](const std::string& name) { return stands_for(name, n.name); };
    const bool target = only.empty() ? n.type->is_sink() : std::ranges::any_of(only, is_meant);
    if (!target || names.size() >= most_shown_nodes) continue;
    if (n.type->is_sink())
      for (const auto& [port, wires] : n.inputs)
        for (const Wire& w : wires) add_name(names, w.node);
    if (!n.type->outputs.empty()) add_name(names, n.name);
    add_origins(graph, n, origins);
  }
  add_indexes(graph, origins);
  std::optional<Plan> plan;
  if (session.cache()) plan = session.plan(graph, {.only = only, .keep = names, .keep_going = true});
  for (const std::string& name : origins) {
    const auto at = std::ranges::find(graph.nodes, name, &GraphNode::name) - graph.nodes.begin();
    if (names.size() < most_shown_nodes && (!plan || is_cheap(plan->stages[size_t(at)]))) add_name(names, name);
  }
  if (names.size() > most_shown_nodes) names.resize(most_shown_nodes);
  return names;
}

ShownMaterials materials_of(const Graph& graph, const RunResult& result) {
  return Materials(graph, result).all();
}

}  // namespace terrazzo
