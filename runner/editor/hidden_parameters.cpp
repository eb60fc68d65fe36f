#include "runner/editor/hidden_parameters.h"

#include <algorithm>

#include "core/base/text.h"
#include "graphs/values/scope.h"

namespace terrazzo {

namespace {

/// Graphs that contain themselves are an error, and are shown all the same.
constexpr int deepest = 16;

bool is_name_character(char c) {
  return c == '_' || (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}

bool has_word(const std::string& text, const std::string& word) {
  for (size_t at = text.find(word); at != text.npos; at = text.find(word, at + 1)) {
    const size_t end = at + word.size();
    if ((at == 0 || !is_name_character(text[at - 1])) && (end == text.size() || !is_name_character(text[end])))
      return true;
  }
  return false;
}

bool names_parameter(const JsonValue& value, const std::string& name) {
  if (value.is_text() && (value.text.starts_with('=') ? has_word(value.text, name) : has_word(value.text, "$" + name)))
    return true;
  return std::ranges::any_of(value.items, [&](const JsonValue& v) { return names_parameter(v, name); }) ||
         std::ranges::any_of(value.members, [&](const JsonMember& m) { return names_parameter(m.value, name); });
}

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
  std::set<std::string> out;
  for (const GraphParameter& p : graph.parameters) {
    const std::string& name = p.param.name;
    bool is_hidden = false, has_effect = false;
    for (const char* section : {"parameters", "outputs", "seed"})
      if (const JsonValue* value = graph.json->find(section)) has_effect |= names_parameter(*value, name);
    for (const JsonMember& node : nodes->members) {
      const auto at = inside.find(node.name);
      for (const JsonMember& m : node.value.members) {
        if (!names_parameter(m.value, name)) continue;
        const bool goes =
            at != inside.end() && at->second.contains(m.name) && m.value.is_text() && m.value.text == "$" + name;
        (goes ? is_hidden : has_effect) = true;
      }
    }
    if (is_hidden && !has_effect) out.insert(name);
  }
  return out;
}

}  // namespace terrazzo
