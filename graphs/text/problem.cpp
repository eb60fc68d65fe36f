#include "graphs/text/problem.h"

#include <algorithm>
#include <map>
#include <stdexcept>
#include <tuple>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace terrazzo {

namespace {

/// "all[sand]" of the node "all[sand]/weighted"; empty if it is in no loop.
std::string iteration_of(const std::string& node) {
  const size_t end = node.rfind(']');
  return end == node.npos ? "" : node.substr(0, end + 1);
}

std::string listed_with_and(std::vector<std::string> names) {
  names.erase(std::unique(names.begin(), names.end()), names.end());
  const std::string last = names.back();
  names.pop_back();
  return names.empty() ? last : fmt::format("{} and {}", fmt::join(names, ", "), last);
}

std::vector<Problem> in_order(std::vector<Problem> problems) {
  const auto key = [](const Problem& p) { return std::tie(p.file, p.place.line, p.place.column); };
  std::stable_sort(problems.begin(), problems.end(), [&](const Problem& a, const Problem& b) {
    return std::pair(a.place.line == 0, key(a)) < std::pair(b.place.line == 0, key(b));
  });
  // Uses of the same subgraph report the same problem; for a loop every affected iteration is named.
  std::map<std::tuple<std::string, int, int, std::string>, size_t> said;
  std::vector<Problem> out;
  std::map<size_t, std::vector<std::string>> more_iterations;
  for (Problem& p : problems) {
    const auto [at, is_new] = said.emplace(std::tuple(p.file, p.place.line, p.place.column, p.message), out.size());
    if (is_new || p.place.line == 0)
      out.push_back(std::move(p));
    else if (const std::string iteration = iteration_of(p.node);
             !iteration.empty() && iteration != iteration_of(out[at->second].node))
      more_iterations[at->second].push_back(iteration);
  }
  for (const auto& [first, iterations] : more_iterations)
    out[first].message += fmt::format("; the same in {}", listed_with_and(iterations));
  return out;
}

/// A hint on the command line values from which a port's or parameter's files come.
std::string files(const GraphNode& node, const std::string& about, const char* how) {
  const auto by = node.files_by.find(about);
  if (by == node.files_by.end() || by->second.empty()) return "";
  std::string names;
  for (const std::string& name : by->second) names += fmt::format("{}--set {}", names.empty() ? "" : ", ", name);
  return fmt::format(" ({}{})", how, names);
}

std::string all_described(const std::string& file, const std::vector<Problem>& problems) {
  std::string text;
  for (size_t i = 0; i < std::min(problems.size(), most_problems_shown); i++) {
    if (!text.empty()) text += '\n';
    text += describe(file, problems[i]);
  }
  const std::string more = problems_not_shown(problems.size());
  return more.empty() ? text : text + '\n' + more;
}

}  // namespace

const std::vector<std::string>& problem_codes() {
  static const std::vector<std::string> codes = {
      "syntax",     // not JSON, a duplicate name, an unknown version
      "document",   // a key, a section, or the declaration of a parameter, preset, input or output
      "override",   // --set, --preset, --params
      "node",       // its name, its type, a loop, a subgraph
      "parameter",  // a value of a node's parameter
      "wire",       // a wire, or a port without one
      "cycle",      // wires or expressions in a cycle
      "unset",      // a parameter or an input without a value
      "input",      // something that a source would read, or another node would refuse
      "unused-parameter",
      "unused-graph",
      "unused-node",
      "no-sink",
      "conversion",
      "doubt",  // allowed but probably unintended
  };
  return codes;
}

void set_code(std::vector<Problem>& problems, size_t first, const std::string& code) {
  if (std::ranges::find(problem_codes(), code) == problem_codes().end())
    throw std::logic_error("no code of problems: " + code);
  for (size_t i = first; i < problems.size(); i++)
    if (problems[i].code.empty()) problems[i].code = code;
}

void set_node(std::vector<Problem>& problems, size_t first, const std::string& node) {
  for (size_t i = first; i < problems.size(); i++) problems[i].node = node;
}

void set_file(std::vector<Problem>& problems, size_t first, const std::string& file) {
  for (size_t i = first; i < problems.size(); i++)
    if (problems[i].file.empty() && problems[i].place.line > 0) problems[i].file = file;
}

std::string describe(const std::string& file, const Problem& problem) {
  std::string text = problem.file.empty() ? file : problem.file;
  if (problem.place.line > 0) text += fmt::format(":{}:{}", problem.place.line, problem.place.column);
  if (!text.empty()) text += ": ";
  if (!problem.where.empty()) text += problem.where + ": ";
  return text + problem.message;
}

std::string problems_not_shown(size_t all, const char* what) {
  if (all <= most_problems_shown) return "";
  const size_t more = all - most_problems_shown;
  std::string number = std::to_string(more);
  for (size_t at = number.size(); at > 3;) number.insert(at -= 3, ",");
  return fmt::format("and {} more {}{}", number, what, more == 1 ? "" : "s");
}

Problem problem_of(const GraphNode& node, const std::string& about, const std::string& message) {
  std::string where = fmt::format("node \"{}\" ({})", node.name, node.type->name);
  if (node.type->find_input(about)) where += fmt::format(", input \"{}\"{}", about, files(node, about, "made from "));
  const std::string param = about.substr(0, about.find('.'));
  if (node.type->find_param(param)) where += fmt::format(", parameter \"{}\"{}", param, files(node, param, ""));
  return {node.place_of(about), where, message, node.name, node.file, "", about};
}

GraphError::GraphError(const std::string& file, std::vector<Problem> problems)
    : GraphError(InOrder{in_order(std::move(problems))}, file) {}

GraphError::GraphError(InOrder ordered, const std::string& file)
    : Error(all_described(file, ordered.problems)), file_(file), problems_(std::move(ordered.problems)) {}

}  // namespace terrazzo
