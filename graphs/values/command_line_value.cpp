#include "core/base/text.h"
#include "graphs/values/convert.h"

namespace terrazzo {

namespace {

using Kind = JsonValue::Kind;

bool has_kind_of(const JsonValue& v, ParamType type) {
  switch (type) {
    case ParamType::boolean:
      return v.kind == Kind::boolean;
    case ParamType::integer:
    case ParamType::number:
      return v.is_number();
    case ParamType::size:
      return v.is_number() || v.is_list() || v.is_text();
    case ParamType::numbers:
      return v.is_number() || v.is_list();
    case ParamType::texts:
      return v.is_list();
    case ParamType::number_map:
    case ParamType::text_map:
      return v.is_object();
    default:
      return v.is_text();
  }
}

/// ".5", "5." and "+5" in JSON's spelling; anything else unchanged.
std::string json_spelling(const std::string& number) {
  const auto digit_at = [](const std::string& text, size_t i) { return i < text.size() && is_digit(text[i]); };
  std::string out = number.starts_with('+') && !number.starts_with("+-") ? number.substr(1) : number;
  const size_t first = out.starts_with('-') ? 1 : 0;
  if (first < out.size() && out[first] == '.' && digit_at(out, first + 1)) out.insert(first, "0");
  const size_t dot = out.find('.');
  if (dot != out.npos && dot > 0 && digit_at(out, dot - 1) && !digit_at(out, dot + 1)) out.insert(dot + 1, "0");
  return out;
}

bool may_be_number(ParamType type) {
  return type == ParamType::integer || type == ParamType::number || type == ParamType::size ||
         type == ParamType::numbers;
}

}  // namespace

JsonValue read_command_line(const std::string& text, const Param& param) {
  ParsedJson parsed = parse_json(may_be_number(param.type) ? json_spelling(text) : text);
  const bool means_json = parsed.problems.empty() && has_kind_of(*parsed.value, param.type);
  JsonValue value = means_json ? std::move(*parsed.value) : JsonValue::of(text);
  if (param.type != ParamType::choice) return value;
  for (const std::string& c : param.choices)
    if (lowercase(c) == lowercase(value.text)) value.text = c;
  return value;
}

}  // namespace terrazzo
