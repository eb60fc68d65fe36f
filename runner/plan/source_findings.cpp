#include "runner/plan/source_findings.h"

#include <algorithm>
#include <set>

#include "core/node/node.h"

namespace terrazzo {

namespace {

bool reads_images(const GraphNode& node) {
  const auto is_picture = [](const Port& p) { return p.type == ValueType::image || p.type == ValueType::material; };
  return !node.is_open && node.type->category == "source" && node.type->files_read && node.inputs.empty() &&
         std::ranges::all_of(node.type->outputs, is_picture) && node.params.size() == node.type->params.size();
}

Digest recipe_of(const GraphNode& node) {
  Hasher hasher;
  hasher.add(node.type->name);
  add_to(hasher, node.params);
  return hasher.digest();
}

void look_at(const GraphNode& node, const Digest& recipe, const Task& task, SourceFindings& out) {
  try {
    const CurrentTask working(task);
    NodeContext context(*node.type, node.params, {}, recipe, task);
    context.compute();
    for (const std::string& note : context.notes())
      if (is_warning(note)) out.warnings.push_back(problem_of(node, "", note.substr(warning_mark.size())));
  } catch (const Errors& all) {
    for (const Error& e : all.all()) out.errors.push_back(problem_of(node, e.about(), e.what()));
  } catch (const Error& e) {
    out.errors.push_back(problem_of(node, e.about(), e.what()));
  }
}

}  // namespace

SourceFindings look_at_sources(const Graph& graph, const Task& task) {
  SourceFindings out;
  std::set<Digest> seen;  // large graphs read one file in many places
  for (const GraphNode& node : graph.nodes) {
    if (!reads_images(node)) continue;
    task.check();
    if (const Digest recipe = recipe_of(node); seen.insert(recipe).second) look_at(node, recipe, task, out);
  }
  set_code(out.errors, 0, "input");
  set_code(out.warnings, 0, "doubt");
  return out;
}

}  // namespace terrazzo
