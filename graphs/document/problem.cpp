#include "graphs/document/problem.h"

#include <algorithm>
#include <tuple>

#include <fmt/format.h>

namespace terrazzo {

namespace {

std::vector<Problem> in_order(std::vector<Problem> problems) {
  const auto key = [](const Problem& p) { return std::tuple(p.place.line == 0, p.place.line, p.place.column); };
  std::stable_sort(problems.begin(), problems.end(),
                   [&](const Problem& a, const Problem& b) { return key(a) < key(b); });
  return problems;
}

std::string all_described(const std::string& file, const std::vector<Problem>& problems) {
  std::string text;
  for (const Problem& p : problems) {
    if (!text.empty()) text += '\n';
    text += describe(file, p);
  }
  return text;
}

}  // namespace

std::string describe(const std::string& file, const Problem& problem) {
  std::string text = file;
  if (problem.place.line > 0) text += fmt::format(":{}:{}", problem.place.line, problem.place.column);
  if (!text.empty()) text += ": ";
  if (!problem.where.empty()) text += problem.where + ": ";
  return text + problem.message;
}

Problem problem_of(const GraphNode& node, const std::string& about, const std::string& message) {
  std::string where = fmt::format("node \"{}\" ({})", node.name, node.type->name);
  if (node.type->find_input(about)) where += fmt::format(", input \"{}\"", about);
  if (node.type->find_param(about)) where += fmt::format(", parameter \"{}\"", about);
  return {node.place_of(about), where, message, node.name};
}

GraphError::GraphError(const std::string& file, std::vector<Problem> problems)
    : Error(all_described(file, in_order(problems))), file_(file), problems_(in_order(std::move(problems))) {}

}  // namespace terrazzo
