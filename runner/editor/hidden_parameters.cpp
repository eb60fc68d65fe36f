#include "runner/editor/hidden_parameters.h"

#include <algorithm>

#include "graphs/values/scope.h"
#include "graphs/values/substitution.h"

namespace terrazzo {

namespace {

/// Graphs that contain themselves are an error, and are shown all the same.
constexpr int deepest = 16;

/// What names parameters: a node's value, or a part of the graph that has an effect in any case.
struct Use {
  std::set<std::string> names;
  std::string whole;             ///< the text, if it is nothing but "$name"
  bool reaches_nothing = false;  ///< the value of a parameter inside that has no effect
};

/// Whether a condition says no; one that cannot be evaluated does not.
bool is_refused(GraphScope& scope, const JsonValue& text) {
  std::vector<Problem> ignored;
  Diagnostics diagnostics(ignored, "", "");
  const std::optional<Expression> condition = parse_expression(text, diagnostics);
  if (!condition || !scope.lacking(*condition).nothing()) return false;
  const std::optional<ParamValue> value = scope.evaluate(*condition, text, "", diagnostics);
  const bool* shown = value ? std::get_if<bool>(&*value) : nullptr;
  return shown && !*shown;
}

}  // namespace

std::set<std::string> HiddenParameters::of_use(const std::string& path, const Subgraph& graph, int depth) {
  const auto at = values_.find(path);
  if (at == values_.end()) return {};
  std::vector<GraphParameter> parameters = graph.parameters;
  for (GraphParameter& p : parameters)
    if (const auto value = at->second->find(p.param.name); value != at->second->end()) {
      p.value = value->second;
      p.formula.reset();
    }
  return of(graph, parameters, path + "/", depth);
}

std::set<std::string> HiddenParameters::of(const Subgraph& graph, const std::vector<GraphParameter>& parameters,
                                           const std::string& path, int depth) {
  if (depth >= deepest) return {};
  std::set<std::string> out = of_insides(graph, path, depth);
  if (std::ranges::none_of(parameters, [](const GraphParameter& p) { return p.visible_if.has_value(); })) return out;
  std::vector<GraphParameter> scoped = parameters;
  std::vector<Problem> ignored;
  GraphScope scope(scoped, {}, "", ignored);  // drops conditions that are wrong
  for (const GraphParameter& p : scoped)
    if (p.visible_if && is_refused(scope, *p.visible_if)) out.insert(p.param.name);
  return out;
}

std::set<std::string> HiddenParameters::of_insides(const Subgraph& graph, const std::string& path, int depth) {
  const JsonValue* nodes = graph.json ? graph.json->find("nodes") : nullptr;
  if (!nodes) return {};
  std::map<std::string, std::set<std::string>> inside;  // by node
  for (const JsonMember& m : nodes->members)
    if (const JsonValue* type = m.value.find("type"); type && type->is_text())
      if (const NodeTypes::value_type* source = graph.find_source(m.name);
          source && source->second && source->second->category == graph_category)
        if (const Subgraph* inner = graphs_.find(*type, graph))
          if (std::set<std::string> hidden = of_use(path + m.name, *inner, depth + 1); !hidden.empty())
            inside.emplace(m.name, std::move(hidden));
  if (inside.empty()) return {};
  std::vector<Use> uses;
  for (const char* section : {"parameters", "outputs", "seed"})
    if (const JsonValue* value = graph.json->find(section)) uses.push_back({parameters_in(*value), "", false});
  for (const JsonMember& node : nodes->members) {
    const auto at = inside.find(node.name);
    for (const JsonMember& m : node.value.members)
      uses.push_back({parameters_in(m.value), m.value.text, at != inside.end() && at->second.contains(m.name)});
  }
  std::set<std::string> out;
  for (const GraphParameter& p : graph.parameters) {
    const std::string& name = p.param.name;
    bool is_hidden = false, has_effect = false;
    for (const Use& use : uses)
      if (use.names.contains(name)) (use.reaches_nothing && use.whole == "$" + name ? is_hidden : has_effect) = true;
    if (is_hidden && !has_effect) out.insert(name);
  }
  return out;
}

}  // namespace terrazzo
