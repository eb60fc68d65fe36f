#include "graphs/document/file_origins.h"

#include <algorithm>
#include <map>

namespace terrazzo {

namespace {

using PathNames = std::set<std::string>;

bool has_parameter(const Level& level, const std::string& name) {
  return std::ranges::find(level.names.parameters, name, [](const GraphParameter& p) { return p.param.name; }) !=
         level.names.parameters.end();
}

/// The document's parameters behind those that a node names. Instead of a loop's variable, which cannot be set, they
/// are those that the loop is made from; of a subgraph's parameter those that its node names, if it says it.
PathNames files_behind(const NodeDraft& node, const PathNames& named) {
  PathNames own;
  for (const std::string& name : named)
    if (has_parameter(*node.level, name))
      own.insert(name);
    else
      own.insert(node.loop_files.begin(), node.loop_files.end());
  const NodeDraft* use = node.level->use;
  if (!use) return own;
  PathNames out;
  for (const std::string& name : own)
    if (const auto given = use->node.files_by.find(name); given != use->node.files_by.end())
      out.merge(files_behind(*use, given->second));
  return out;
}

}  // namespace

void trace_files(Drafts& drafts, const std::vector<size_t>& order) {
  std::map<std::string, PathNames> files_of;  // by node
  for (const size_t i : order) {
    GraphNode& node = drafts[i].node;
    for (auto& [given, files] : node.files_by) files = files_behind(drafts[i], files);
    for (const auto& [port, wires] : node.inputs)
      for (const Wire& w : wires) node.files_by[port].merge(PathNames(files_of[w.node]));
    for (const auto& [given, files] : node.files_by) files_of[node.name].insert(files.begin(), files.end());
  }
}

}  // namespace terrazzo
