#include "graphs/document/file_origins.h"

#include <algorithm>
#include <iterator>
#include <map>

namespace terrazzo {

namespace {

using ParameterNames = std::set<std::string>;

/// The document's path parameters behind those that a node names. A loop's variable, which cannot be set, is replaced
/// by the parameters of the loop's source; a subgraph's parameter by those that its node names, if it sets it.
ParameterNames files_behind(const NodeDraft& node, const ParameterNames& named) {
  ParameterNames own;
  for (const std::string& name : named) {
    if (!node.substitution->is_path(name)) continue;
    if (node.level->names.scope->look_up(name))
      own.insert(name);
    else
      std::ranges::copy_if(node.loop_names, std::inserter(own, own.end()),
                           [&](const std::string& n) { return node.level->names.substitution->is_path(n); });
  }
  const NodeDraft* use = node.level->use;
  if (!use) return own;
  ParameterNames out;
  for (const std::string& name : own)
    if (const auto given = use->names_by.find(name); given != use->names_by.end())
      out.merge(files_behind(*use, given->second));
  return out;
}

/// Limits the names that a long chain of nodes accumulates; nobody reads a longer list.
void add_first(const ParameterNames& names, ParameterNames& to) {
  constexpr size_t most = 16;
  for (const std::string& name : names)
    if (to.size() < most) to.insert(name);
}

/// Collects settable values without duplicates.
class SettablesBehind {
 public:
  void add(const NodeDraft& node, const ParameterNames& named) {
    for (const std::string& name : named) {
      if (node.level->names.scope->look_up(name)) {
        add(*node.level, name);
      } else if (node.local.ends_with(']')) {
        const std::string loop = node.node.name.substr(0, node.node.name.size() - node.local.size()) +
                                 node.local.substr(0, node.local.find('['));
        if (seen_.emplace(node.level, loop + ".foreach").second) out_.push_back({loop, "foreach"});
        for (const std::string& source : node.loop_names) add(*node.level, source);
      }
    }
  }

  void add(const Level& level, const std::string& name) {
    const GraphParameter* p = level.names.scope->look_up(name);
    if (!p || !seen_.emplace(&level, name).second) return;
    const bool is_path = p->param.type == ParamType::path && p->value;
    out_.push_back({level.use ? level.use->node.name : "", name, is_path ? std::get<std::string>(*p->value) : ""});
    if (p->formula)
      for (const auto& [other, offset] : p->formula->expression->parameters()) add(level, other);
    if (!level.use) return;
    if (const auto given = level.use->names_by.find(name); given != level.use->names_by.end())
      add(*level.use, given->second);
  }

  std::vector<Settable> take() { return std::move(out_); }

 private:
  std::set<std::pair<const Level*, std::string>> seen_;
  std::vector<Settable> out_;
};

}  // namespace

std::vector<Settable> settables_behind(const Level& level, const std::set<std::string>& parameters) {
  SettablesBehind out;
  for (const std::string& name : parameters) out.add(level, name);
  return out.take();
}

void trace_settables(Drafts& drafts) {
  for (NodeDraft& d : drafts)
    for (const auto& [given, names] : d.names_by) {
      const Param* param = d.node.type ? d.node.type->find_param(given) : nullptr;
      if (!param || param->type != ParamType::path) continue;
      SettablesBehind behind;
      behind.add(d, names);
      d.set_by[given] = behind.take();
    }
}

void trace_files(Drafts& drafts, const std::vector<size_t>& order) {
  std::map<std::string, ParameterNames> files_of;  // by node
  for (const size_t i : order) {
    GraphNode& node = drafts[i].node;
    for (const auto& [given, names] : drafts[i].names_by) {
      const Param* param = node.type ? node.type->find_param(given) : nullptr;
      if (!param || param->type != ParamType::path) continue;
      node.files_by[given] = files_behind(drafts[i], names);
    }
    for (const auto& [port, wires] : node.inputs)
      for (const Wire& w : wires) add_first(files_of[w.node], node.files_by[port]);
    for (const auto& [given, files] : node.files_by) add_first(files, files_of[node.name]);
  }
}

}  // namespace terrazzo
