#include "runner/editor/state_problems.h"

#include <algorithm>

namespace terrazzo {

namespace {

/// The steps of a JSON pointer.
std::vector<std::string> steps_of(const std::string& pointer) {
  std::vector<std::string> out;
  for (const char c : pointer) {
    if (c == '/')
      out.emplace_back();
    else if (!out.empty())
      out.back() += c;
  }
  return out;  // names of nodes and keys have neither ~ nor /
}

std::string plain_name(const std::string& step) {
  return step.substr(0, step.find('['));
}

}  // namespace

void StateProblems::add(const std::vector<Problem>& problems, const char* severity) {
  for (size_t i = 0; i < std::min(problems.size(), most_problems_shown); i++) {
    const Problem& p = problems[i];
    nlohmann::ordered_json entry = as_json_.entry(p, severity);
    if (!known_.insert(entry.value("file", "") + entry.value("pointer", "") + p.where + p.message).second) continue;
    locate(entry, p);
    all_.push_back(std::move(entry));
  }
}

/// By the pointer if the problem is in the document, else by the node whose graph it is in.
void StateProblems::locate(nlohmann::ordered_json& entry, const Problem& problem) const {
  const bool is_here = problem.file.empty() || problem.file == file_;
  std::vector<std::string> steps = is_here ? steps_of(entry.value("pointer", "")) : std::vector<std::string>();
  std::string level;
  if (steps.size() > 2 && steps[0] == "graphs") {
    level = steps[1];
    steps.erase(steps.begin(), steps.begin() + 2);
  }
  if (steps.size() > 1 && steps[0] == "nodes") {
    entry["level"] = level;
    entry["node"] = steps[1];
    if (steps.size() > 2)
      entry["key"] = steps[2];
    else if (!problem.parameter.empty())
      entry["key"] = problem.parameter.substr(0, problem.parameter.find('.'));
    return;
  }
  if (!steps.empty()) {
    entry.erase("node");
    entry["level"] = level;
    entry["key"] = steps.size() > 1 ? steps[1] : steps[0];
    return;
  }
  if (problem.node.empty() || !json_) return;
  // The deepest node of this document on the way to it.
  const std::vector<std::string> path = steps_of("/" + problem.node);
  std::string node = plain_name(path.front());
  const JsonValue* graphs = json_->find("graphs");
  for (size_t i = 1; i < path.size(); i++) {
    const JsonValue* graph = level.empty() ? &*json_ : graphs ? graphs->find(level) : nullptr;
    const JsonValue* nodes = graph ? graph->find("nodes") : nullptr;
    const JsonValue* use = nodes ? nodes->find(node) : nullptr;
    const JsonValue* type = use ? use->find("type") : nullptr;
    if (!type || !graphs || !graphs->find(type->text)) break;
    level = type->text;
    node = plain_name(path[i]);
  }
  entry["level"] = level;
  entry["node"] = node;
  if (!problem.parameter.empty() && !entry.contains("key"))
    entry["key"] = problem.parameter.substr(0, problem.parameter.find('.'));
}

}  // namespace terrazzo
