#include "graphs/values/scope.h"

#include <algorithm>
#include <map>

#include <fmt/format.h>

#include "core/base/suggest.h"
#include "graphs/expression/operations.h"
#include "graphs/text/json.h"
#include "graphs/values/convert.h"

namespace terrazzo {

namespace {

/// Sizes are in pixels by default.
std::string unit_of(const Param& param) {
  const std::string unit = expression::plain_unit(param.unit);
  return unit.empty() && param.type == ParamType::size ? "pixels" : unit;
}

}  // namespace

GraphScope::GraphScope(std::vector<GraphParameter>& parameters, const NodeTypes& nodes, const std::string& path,
                       std::vector<Problem>& problems)
    : parameters_(parameters), problems_(problems), path_(path) {
  for (size_t i = 0; i < parameters.size(); i++) {
    names_.push_back(parameters[i].param.name);
    positions_.emplace(names_.back(), i);
  }
  for (const auto& [node, type] : nodes) node_names_.insert(node);
  check_formulas();
  report_cycles();
}

GraphScope::GraphScope(std::vector<GraphParameter>& variables, GraphScope& around)
    : parameters_(variables), problems_(around.problems_), around_(&around), path_(around.path_) {
  for (size_t i = 0; i < variables.size(); i++) {
    names_.push_back(variables[i].param.name);
    positions_.emplace(names_.back(), i);
  }
}

std::vector<std::string> GraphScope::names() const {
  std::vector<std::string> out = around_ ? around_->names() : std::vector<std::string>();
  out.insert(out.end(), names_.begin(), names_.end());
  return out;
}

std::string GraphScope::where(const GraphParameter& p) const {
  const std::string node = path_.empty() ? "" : fmt::format("node {}, ", in_quotes(path_.substr(0, path_.size() - 1)));
  return node + "parameter " + in_quotes(p.param.name);
}

GraphParameter* GraphScope::position(const std::string& name) const {
  const auto at = positions_.find(name);
  if (at != positions_.end()) return &parameters_[at->second];
  return around_ ? around_->position(name) : nullptr;
}

const GraphParameter* GraphScope::find(const std::string& name) {
  if (around_ && !positions_.contains(name)) return around_->find(name);
  GraphParameter* p = position(name);
  if (p) evaluate(*p);
  return p;
}

void GraphScope::collect(const std::string& parameter, std::set<std::string>& seen, Lacking& out) const {
  const GraphParameter* p = position(parameter);
  if (!p || p->value || !seen.insert(parameter).second) return;
  if (p->is_wrong) {
    out.wrong = true;
  } else if (p->pending) {
    out.add(*p->pending);
  } else if (p->formula) {
    collect(*p->formula->expression, seen, out);
  } else {
    out.unset.insert(parameter);
  }
}

void GraphScope::collect(const Expression& expression, std::set<std::string>& seen, Lacking& out) const {
  for (const auto& [name, offset] : expression.parameters()) collect(name, seen, out);
  if (!forecasts_)
    for (const auto& [name, offset] : expression.nodes()) out.nodes.insert(path_ + name);
}

Lacking GraphScope::lacking(const std::string& parameter) const {
  Lacking out;
  std::set<std::string> seen;
  collect(parameter, seen, out);
  return out;
}

Lacking GraphScope::lacking(const Expression& expression) const {
  Lacking out;
  std::set<std::string> seen;
  collect(expression, seen, out);
  return out;
}

bool GraphScope::check_names(const Expression& expression, const JsonValue& text, Diagnostics& diagnostics) const {
  bool known = true;
  for (const auto& [name, offset] : expression.parameters()) {
    if (position(name)) continue;
    known = false;
    const std::vector<std::string> all = hints_++ < most_problems_shown ? names() : names_;
    const std::string hint = all.empty() ? "; it has none" : suggestion(name, all);
    diagnostics.add(place_in(text, offset),
                    fmt::format("the graph has no parameter {}{}, in {}", in_quotes(name), hint, excerpt(text.text)));
  }
  for (const auto& [name, offset] : expression.nodes()) {
    const std::set<std::string>& known_nodes = around_ ? around_->node_names_ : node_names_;
    if (known_nodes.contains(name)) continue;
    known = false;
    std::vector<std::string> all;  // candidates for a suggestion; none for problems that will not be shown
    if (hints_++ < most_problems_shown) all.assign(known_nodes.begin(), known_nodes.end());
    diagnostics.add(place_in(text, offset),
                    fmt::format("@{} leads to no node{}, in {}", name, suggestion(name, all), excerpt(text.text)));
  }
  return known;
}

void GraphScope::check_formulas() {
  for (GraphParameter& p : parameters_) {
    if (p.visible_if) check_condition(p);
    if (!p.formula || p.is_wrong) continue;
    Diagnostics diagnostics = p.formula->diagnostics(problems_, where(p), p.param.name);
    p.is_wrong = !check_names(*p.formula->expression, p.formula->text, diagnostics);
  }
}

void GraphScope::check_condition(GraphParameter& p) {
  Diagnostics diagnostics(problems_, where(p), p.param.name);
  const std::optional<Expression> condition = parse_expression(*p.visible_if, diagnostics);
  if (condition && !condition->nodes().empty())
    diagnostics.add(
        place_in(*p.visible_if, condition->nodes().begin()->second),
        fmt::format("\"visible_if\" is evaluated before nodes are known, in {}", excerpt(p.visible_if->text)));
  else if (condition && check_names(*condition, *p.visible_if, diagnostics))
    return;
  p.visible_if.reset();
}

std::optional<ParamValue> GraphScope::evaluate(const Expression& expression, const JsonValue& value,
                                               const std::string& unit, Diagnostics& diagnostics) {
  try {
    const ExpressionValue out = expression.evaluate(*this);
    const std::string wanted = expression::plain_unit(unit);
    if (!wanted.empty() && !out.unit.empty() && wanted != out.unit) {
      diagnostics.add(value.place,
                      fmt::format("expected {}, found a value in {}, in {}", wanted, out.unit, excerpt(value.text)));
      return std::nullopt;
    }
    return out.value;
  } catch (const ExpressionError& e) {
    diagnostics.add(place_in(value, e.offset()), fmt::format("{}, in {}", e.what(), excerpt(value.text)));
    return std::nullopt;
  }
}

void GraphScope::evaluate(GraphParameter& p) {
  if (p.value || p.is_wrong || p.pending || !p.formula || !lacking(p.param.name).nothing()) return;
  Diagnostics diagnostics = p.formula->diagnostics(problems_, where(p), p.param.name);
  const std::optional<ParamValue> result =
      evaluate(*p.formula->expression, p.formula->text, unit_of(p.param), diagnostics);
  if (result) {
    JsonValue json = json_of(*result);
    json.place = p.formula->text.place;
    diagnostics.set_origin(fmt::format(" (from {})", excerpt(p.formula->text.text)));
    p.value = read_param(json, p.param, p.formula->base, diagnostics);
    if (json.is_text()) p.as_written = json.text;
  }
  p.is_wrong = !p.value;
}

void GraphScope::add_what_they_use(std::set<std::string>& parameters) const {
  std::vector<std::string> open(parameters.begin(), parameters.end());
  while (!open.empty()) {
    const GraphParameter* p = position(open.back());
    open.pop_back();
    if (!p || !p->formula) continue;
    for (const auto& [name, offset] : p->formula->expression->parameters())
      if (parameters.insert(name).second) open.push_back(name);
  }
}

void GraphScope::evaluate_parameters() {
  for (GraphParameter& p : parameters_) evaluate(p);
}

/// Reports parameters that depend on themselves or on too long a chain of others.
void GraphScope::report_cycles() {
  constexpr int most = 100;  // keeps evaluation from overflowing the stack
  constexpr int open = -1;
  std::map<std::string, int> heights;  // the length of the chain that each parameter depends on
  std::vector<std::string> path;
  const auto report = [&](GraphParameter& p, const std::string& message) {
    p.formula->diagnostics(problems_, where(p), p.param.name).add(p.formula->text.place, message);
    p.is_wrong = true;
    return 0;
  };
  const std::function<int(GraphParameter&)> visit = [&](GraphParameter& p) -> int {
    if (!p.formula || p.is_wrong) return 0;
    const auto [known, is_new] = heights.emplace(p.param.name, open);
    if (!is_new && known->second != open) return known->second;
    if (!is_new)
      return report(p, fmt::format("its value depends on itself: {} -> {}",
                                   fmt::join(std::ranges::find(path, p.param.name), path.end(), " -> "), p.param.name));
    int height = 0;
    path.push_back(p.param.name);
    if (path.size() <= size_t(most))
      for (const auto& [name, offset] : p.formula->expression->parameters())
        if (GraphParameter* other = position(name)) height = std::max(height, visit(*other));
    path.pop_back();
    if (height >= most || path.size() >= size_t(most))
      return report(p, fmt::format("its value depends on a chain of more than {} others", most));
    return known->second = height + 1;
  };
  for (GraphParameter& p : parameters_) visit(p);
}

ExpressionValue GraphScope::parameter(const std::string& name) {
  const GraphParameter* p = find(name);
  if (!p || !p->value) throw Error(fmt::format("the parameter \"{}\" has no value", name));
  return {*p->value, unit_of(p->param)};
}

const Forecast& GraphScope::forecast(const std::string& node) {
  if (!forecasts_) throw Error(fmt::format("nothing is known of \"{}\" yet", node));
  return forecasts_(path_ + node);
}

}  // namespace terrazzo
