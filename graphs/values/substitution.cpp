#include "graphs/values/substitution.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/base/suggest.h"
#include "core/base/text.h"
#include "graphs/expression/operations.h"
#include "graphs/values/convert.h"

namespace terrazzo {

namespace {

bool takes_texts(ParamType type) {
  return type == ParamType::text || type == ParamType::texts || type == ParamType::text_map ||
         type == ParamType::choice || type == ParamType::path;
}

JsonValue placed(JsonValue value, Place place) {
  value.place = place;
  for (JsonValue& item : value.items) item = placed(std::move(item), place);
  for (JsonMember& m : value.members) m = {m.name, place, placed(std::move(m.value), place)};
  return value;
}

/// An expression's value as text, for a parameter that takes texts.
JsonValue as_text(const JsonValue& v, const ParamValue& value) {
  JsonValue out = JsonValue::of(text_of(value));
  out.place = v.place;
  return out;
}

/// A hint on how to write "$size/2" if arithmetic was meant.
std::string expression_hint(const std::string& text, const Param& param) {
  if (takes_texts(param.type) || text.find('$') == std::string::npos) return "";
  if (text.find_first_of("+-*/%") == std::string::npos) return "";
  std::string plain;
  for (const char c : text)
    if (c != '$' && c != '{' && c != '}') plain += c;
  return fmt::format("; to compute with it, write {}", in_quotes("=" + plain));
}

}  // namespace

std::optional<ParameterReference> reference_at(const std::string& text, size_t at) {
  const bool is_braced = text.compare(at, 2, "${") == 0;
  const size_t begin = at + 1 + is_braced;
  size_t end = begin;
  while (end < text.size() && is_word(text[end])) end++;
  const bool is_closed = !is_braced || (end < text.size() && text[end] == '}');
  if (end == begin || !is_closed) return std::nullopt;
  return ParameterReference{text.substr(begin, end - begin), end + is_braced};
}

std::optional<JsonValue> Substitution::expand(const JsonValue& value, const Param& param, Diagnostics& diagnostics) {
  put_in_ = 0;
  std::optional<JsonValue> out = expand_part(value, param, diagnostics);
  const bool has_changed = out && value.is_text() && (!out->is_text() || out->text != value.text);
  if (has_changed) {
    const bool is_number_in_text = out->is_text() && !is_expression(value.text);
    diagnostics.set_origin(fmt::format(" (from {}{})", in_quotes(value.text),
                                       is_number_in_text ? expression_hint(value.text, param) : ""));
  }
  return out;
}

std::optional<JsonValue> Substitution::expand_part(const JsonValue& value, const Param& param,
                                                   Diagnostics& diagnostics) {
  if (value.is_text()) return expand_text(value, param, diagnostics);
  JsonValue out = value;
  bool complete = true;
  const auto replace = [&](JsonValue& part) {
    std::optional<JsonValue> expanded = expand_part(part, param, diagnostics);
    complete &= expanded.has_value();
    if (expanded) part = std::move(*expanded);
  };
  for (JsonValue& item : out.items) replace(item);
  for (JsonMember& m : out.members) replace(m.value);
  return complete ? std::optional(std::move(out)) : std::nullopt;
}

/// Limits the text that names insert into a value: short texts that name one another, or are named often, could exceed
/// any memory.
bool Substitution::has_room(const ParamValue& value, Place place, Diagnostics& diagnostics) {
  put_in_ += expression::bytes_of(value);
  if (put_in_ <= expression::most_text_bytes) return true;
  diagnostics.add(place, "with the names in it replaced, it is longer than 1 MiB");
  return false;
}

/// Records what is lacking; false if anything is.
bool Substitution::has_all(const Lacking& lacking) {
  lacking_.add(lacking);
  return lacking.nothing();
}

std::optional<JsonValue> Substitution::expand_expression(const JsonValue& value, const Param& param,
                                                         Diagnostics& diagnostics) {
  const std::optional<Expression> expression = parse_expression(value, diagnostics);
  if (!expression) return std::nullopt;
  for (const auto& [name, offset] : expression->parameters()) used_.insert(name);
  if (!scope_.check_names(*expression, value, diagnostics) || !has_all(scope_.lacking(*expression)))
    return std::nullopt;
  const std::optional<ParamValue> result = scope_.evaluate(*expression, value, param.unit, diagnostics);
  if (!result || !has_room(*result, value.place, diagnostics)) return std::nullopt;
  JsonValue out = placed(json_of(*result), value.place);
  const bool is_plain = out.is_number() || out.kind == JsonValue::Kind::boolean;
  return is_plain && takes_texts(param.type) ? as_text(value, *result) : out;
}

std::optional<JsonValue> Substitution::expand_text(const JsonValue& value, const Param& param,
                                                   Diagnostics& diagnostics) {
  const std::string& text = value.text;
  if (text.starts_with("@") && !text.starts_with("@@")) {
    diagnostics.add(
        value.place,
        fmt::format("a parameter takes no wire; found {} (write @@ for a text that begins with @)", in_quotes(text)));
    return std::nullopt;
  }
  if (is_expression(text)) return expand_expression(value, param, diagnostics);
  JsonValue out = value;
  out.text.clear();
  bool complete = true;
  for (size_t at = text.starts_with("@@") || text.starts_with("==") ? 1 : 0; at < text.size();) {
    if (text[at] != '$' || text.compare(at, 2, "$$") == 0) {
      out.text += text[at];
      at += text[at] == '$' ? 2 : 1;
      continue;
    }
    const std::optional<ParameterReference> reference = reference_at(text, at);
    if (!reference) {
      diagnostics.add(
          value.place,
          fmt::format("expected a parameter's name after $ in {} (a plain dollar is written $$)", in_quotes(text)));
      return std::nullopt;
    }
    const GraphParameter* parameter = scope_.find(reference->name);
    if (!parameter) {
      const std::vector<std::string> all = hints_++ < most_problems_shown ? scope_.names() : std::vector<std::string>();
      const std::string hint = hints_ > most_problems_shown ? ""
                               : all.empty()                ? "; it has none"
                                                            : suggestion(reference->name, all);
      diagnostics.add(value.place,
                      fmt::format("${}: the graph has no parameter of that name{}", reference->name, hint));
    }
    used_.insert(reference->name);
    if (parameter && parameter->value && !has_room(*parameter->value, value.place, diagnostics)) return std::nullopt;
    if (parameter && parameter->value) {
      const bool is_whole = at == 0 && reference->end == text.size();
      const bool is_list =
          std::holds_alternative<Texts>(*parameter->value) || std::holds_alternative<TextMap>(*parameter->value);
      if (is_whole && (is_list || !takes_texts(param.type))) return placed(json_of(*parameter->value), value.place);
      const bool keeps_spelling = parameter->param.type == ParamType::path && at > 0;
      out.text += keeps_spelling ? parameter->as_written : text_of(*parameter->value);
    } else {
      if (parameter) has_all(scope_.lacking(reference->name));
      complete = false;
    }
    at = reference->end;
  }
  return complete ? std::optional(std::move(out)) : std::nullopt;
}

std::set<std::string> parameters_in(const JsonValue& value) {
  std::set<std::string> out;
  for (const JsonValue& item : value.items) out.merge(parameters_in(item));
  for (const JsonMember& m : value.members) out.merge(parameters_in(m.value));
  if (is_expression(value.text)) {
    std::vector<Problem> ignored;
    Diagnostics diagnostics(ignored, "");
    if (const std::optional<Expression> expression = parse_expression(value, diagnostics))
      for (const auto& [name, offset] : expression->parameters()) out.insert(name);
    return out;
  }
  for (size_t at = value.text.find('$'); at != std::string::npos; at = value.text.find('$', at + 1)) {
    if (value.text.compare(at, 2, "$$") == 0) {
      at++;
      continue;
    }
    if (const std::optional<ParameterReference> reference = reference_at(value.text, at)) out.insert(reference->name);
  }
  return out;
}

}  // namespace terrazzo
