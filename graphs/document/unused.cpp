#include "graphs/document/unused.h"

#include <algorithm>
#include <set>

#include "graphs/document/wires.h"

namespace terrazzo {

namespace {

/// The parameters that a level's nodes, or its other parameters, use.
std::set<std::string> used_parameters(const Level& level) {
  std::set<std::string> out = level.names.substitution->used();
  for (const auto& iteration : level.iterations)
    out.insert(iteration->substitution->used().begin(), iteration->substitution->used().end());
  level.names.scope->add_what_they_use(out);
  // A parameter that only a default uses counts as used, even if an override replaces the default.
  for (const GraphParameter& p : level.graph->parameters)
    if (p.formula)
      for (const auto& [name, offset] : p.formula->expression->parameters()) out.insert(name);
  return out;
}

/// Nodes that outputs refer to or that an expression may select, with all their sources by name.
std::set<std::string> names_given(const Levels& levels, const Level& root) {
  std::set<std::string> out;
  std::vector<std::string> open;
  for (const auto& [name, wires] : root.outputs)
    for (const WireEnd& end : wires.wires) open.push_back(end.node);
  const auto add_named = [&](const NodeDraft& d) { open.insert(open.end(), d.named.begin(), d.named.end()); };
  std::ranges::for_each(levels.nodes(), add_named);
  std::ranges::for_each(levels.others(), add_named);
  // A subgraph may select among its inputs.
  for (const NodeDraft& d : levels.others())
    if (d.level == &root)
      for (const PortWires& p : d.ports)
        for (const WireEnd& end : p.wires) open.push_back(end.node);
  while (!open.empty()) {
    const std::string name = std::move(open.back());
    open.pop_back();
    const std::vector<NodeInstance>* items = root.find(name);
    if (!items || !out.insert(name).second) continue;
    for (const NodeInstance& item : *items)
      for (const PortWires& p : item.draft->ports)
        for (const WireEnd& end : p.wires) open.push_back(end.node);
  }
  return out;
}

}  // namespace

std::vector<Problem> warnings_about(const Levels& levels, const Subgraphs& subgraphs, const Level& root,
                                    const std::vector<size_t>& order) {
  std::vector<Problem> out;
  const std::set<std::string> used_by_any = used_parameters(root);
  for (const GraphParameter& p : root.names.parameters)
    if (!used_by_any.contains(p.param.name))
      out.push_back({p.place, "parameter " + in_quotes(p.param.name), "no node uses it", "", "", "unused-parameter"});
  for (const auto& [name, place] : subgraphs.unused())
    out.push_back({place, "graph " + in_quotes(name), "no node is of this type", "", "", "unused-graph"});
  const Drafts& drafts = levels.nodes();
  std::vector<std::string> used;
  bool has_sink = !root.graph->outputs.empty();
  for (const NodeDraft& d : drafts) {
    has_sink |= d.node.type->is_sink();
    if (d.node.type->is_sink()) used.push_back(d.node.name);
  }
  if (!has_sink) {
    out.push_back({{}, "", "no node is a sink: a run writes nothing", "", "", "no-sink"});
    return out;
  }
  std::set<std::string> given = names_given(levels, root);
  const std::set<std::string> needed = needed_nodes(drafts, used);
  for (const size_t i : order) {
    const NodeDraft& d = drafts[i];
    if (d.level == &root && !needed.contains(d.node.name) && !given.contains(d.local))
      out.push_back({d.node.place, "node " + in_quotes(d.node.name), "no sink reads it; it will not run", d.node.name,
                     "", "unused-node"});
  }
  return out;
}

}  // namespace terrazzo
