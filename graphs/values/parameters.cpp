#include "graphs/values/parameters.h"

#include <algorithm>
#include <map>

#include <fmt/format.h>

#include "core/base/suggest.h"
#include "core/base/text.h"
#include "core/file/read_guard.h"
#include "graphs/text/json.h"
#include "graphs/values/convert.h"

namespace terrazzo {

namespace {

/// The end of a message about a graph parameter that does not exist.
std::string hint_for(const std::string& wrong, const std::vector<std::string>& names, const NodeTypes& nodes) {
  std::vector<std::string> of_nodes;
  for (const auto& [node, type] : nodes) {
    if (node == wrong && type && type->name == "input")
      return fmt::format(
          "; \"{0}\" is an input, which takes a wire: make the graph a node of another one, such as {{\"type\": "
          "\"FILE.json\", \"{0}\": \"@node\"}}",
          wrong);
    if (node == wrong) return fmt::format("; \"{0}\" is a node: write {0}.parameter=value", wrong);
    if (type && type->find_param(wrong)) of_nodes.push_back(node + "." + wrong);
  }
  const std::string own = names.empty()      ? "; it has none"
                          : of_nodes.empty() ? suggestion(wrong, names)
                                             : fmt::format(" (valid: {})", listed(names));
  return of_nodes.empty() ? own : fmt::format("{}; did you mean {}?", own, listed(of_nodes));
}

}  // namespace

Diagnostics Formula::diagnostics(std::vector<Problem>& problems, const std::string& where,
                                 const std::string& parameter) const {
  return by ? by->diagnostics(problems) : Diagnostics(problems, where, parameter);
}

Place place_in(const JsonValue& text, size_t offset) {
  Place out = text.place;
  const auto is_character = [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; };
  // The quote, the = and the text before the offset.
  if (out.column > 0)
    out.column += 1 + int(std::ranges::count_if(std::string_view(text.text).substr(0, offset + 1), is_character));
  return out;
}

std::optional<Expression> parse_expression(const JsonValue& text, Diagnostics& diagnostics) {
  try {
    return Expression(std::string_view(text.text).substr(1));
  } catch (const ExpressionError& e) {
    diagnostics.add(place_in(text, e.offset()), fmt::format("{}, in {}", e.what(), excerpt(text.text)));
    return std::nullopt;
  }
}

std::optional<Formula> formula_of(const JsonValue& text, const std::filesystem::path& base, std::optional<Override> by,
                                  Diagnostics& diagnostics) {
  std::optional<Expression> expression = parse_expression(text, diagnostics);
  if (!expression) return std::nullopt;
  return Formula{std::make_shared<const Expression>(std::move(*expression)), text, base, std::move(by)};
}

const std::vector<std::string>& parameter_type_names() {
  static const std::vector<std::string> names = {"bool",  "int",        "number",   "text",   "size", "numbers",
                                                 "texts", "number_map", "text_map", "choice", "path"};
  return names;
}

bool is_parameter_name(const std::string& name) {
  return !name.empty() && is_letter(name[0]) && std::all_of(name.begin(), name.end(), is_word);
}

bool is_node_name(const std::string& name) {
  return !name.empty() && std::all_of(name.begin(), name.end(), [](char c) { return is_word(c) || c == '-'; });
}

void set_parameters(std::vector<GraphParameter>& parameters, const std::vector<Override>& overrides,
                    const NodeTypes& nodes, std::vector<Problem>& problems) {
  std::vector<std::string> names;
  std::map<std::string, size_t> positions;
  for (const GraphParameter& p : parameters) {
    positions.emplace(p.param.name, names.size());
    names.push_back(p.param.name);
  }
  size_t hints = 0;
  for (const Override& o : overrides) {
    if (!o.node.empty()) continue;
    Diagnostics diagnostics = o.diagnostics(problems);
    const auto at = positions.find(o.name);
    if (at == positions.end()) {
      const std::string hint = hints++ < most_problems_shown ? hint_for(o.name, names, nodes) : "";
      diagnostics.add(o.place, fmt::format("the graph has no parameter {}{}", in_quotes(o.name), hint));
      continue;
    }
    GraphParameter& p = parameters[at->second];
    p.overridden = true;
    if (p.is_wrong) continue;
    const JsonValue json = o.json_for(p.param);
    p.as_written = o.json ? o.json->text : o.value;
    p.value.reset();
    p.formula.reset();
    if (json.is_text() && is_expression(json.text)) {
      p.formula = formula_of(json, o.base, o, diagnostics);
      p.is_wrong = !p.formula;
    } else {
      p.value = read_param(json, p.param, o.base, diagnostics);
      p.is_wrong = !p.value;
      if (o.allows_reading && p.value && p.param.type == ParamType::path)
        ReadGuard::allow(std::get<std::string>(*p.value));
    }
  }
}

std::vector<GraphSetting> settings_of(const std::vector<GraphParameter>& parameters) {
  std::vector<GraphSetting> out;
  for (const GraphParameter& p : parameters)
    if (p.value) out.push_back({p.param.name, *p.value, p.param.help, p.overridden});
  return out;
}

}  // namespace terrazzo
