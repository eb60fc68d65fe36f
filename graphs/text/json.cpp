#include "graphs/text/json.h"

#include <algorithm>
#include <map>

#include <fmt/format.h>

namespace terrazzo {

const JsonValue* JsonValue::find(std::string_view name) const {
  for (const JsonMember& m : members)
    if (m.name == name) return &m.value;
  return nullptr;
}
JsonValue* JsonValue::find(std::string_view name) {
  for (JsonMember& m : members)
    if (m.name == name) return &m.value;
  return nullptr;
}

void JsonValue::set(const std::string& name, JsonValue value) {
  if (JsonValue* there = find(name))
    *there = std::move(value);
  else
    members.push_back({name, {}, std::move(value)});
}

JsonValue JsonValue::empty_object() {
  JsonValue out;
  out.kind = Kind::object;
  return out;
}

JsonValue JsonValue::of(std::string text) {
  JsonValue v;
  v.kind = Kind::text;
  v.text = std::move(text);
  return v;
}

JsonValue JsonValue::of(int64_t integer) {
  JsonValue v;
  v.kind = Kind::integer;
  v.integer = integer;
  v.number = static_cast<double>(integer);
  v.text = std::to_string(integer);
  return v;
}

std::string in_quotes(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    switch (c) {
      case '"':
        out += "\\\"";
        break;
      case '\\':
        out += "\\\\";
        break;
      case '\n':
        out += "\\n";
        break;
      case '\t':
        out += "\\t";
        break;
      case '\r':
        out += "\\r";
        break;
      default:
        if (static_cast<uint8_t>(c) < 0x20) {
          out += fmt::format("\\u{:04x}", c);
        } else {
          out += c;
        }
    }
  }
  return out + "\"";
}

std::string excerpt(std::string_view text, size_t most) {
  if (text.size() <= most) return in_quotes(text);
  size_t end = most;
  while (end > 0 && (static_cast<uint8_t>(text[end]) & 0xC0) == 0x80) end--;
  return in_quotes(text.substr(0, end)) + " and so on";
}

std::string found(const JsonValue& value) {
  constexpr size_t most = 60;
  switch (value.kind) {
    case JsonValue::Kind::null:
      return "null";
    case JsonValue::Kind::boolean:
      return value.boolean ? "true" : "false";
    case JsonValue::Kind::integer:
    case JsonValue::Kind::number:
      return "the number " + value.text.substr(0, most);
    case JsonValue::Kind::list:
      return value.items.empty() ? "an empty list" : fmt::format("a list of {}", value.items.size());
    case JsonValue::Kind::object:
      return value.members.empty() ? "an empty object" : "an object";
    case JsonValue::Kind::text:
      break;
  }
  if (value.text.empty()) return "an empty text";
  return fmt::format("the text {}", excerpt(value.text, most));
}

namespace {

bool is_at_or_before(Place a, Place b) {
  return a.line < b.line || (a.line == b.line && a.column <= b.column);
}

std::string escaped(const std::string& name) {
  std::string out;
  for (const char c : name) out += c == '~' ? "~0" : c == '/' ? "~1" : std::string(1, c);
  return out;
}

}  // namespace

std::string pointer_of(const std::vector<std::string>& path) {
  std::string out;
  for (const std::string& step : path) out += "/" + escaped(step);
  return out;
}

std::string pointer_to(const JsonValue& document, Place place) {
  std::string out;
  // The last part that begins at or before the place contains it.
  for (const JsonValue* v = &document; v;) {
    const JsonValue* inside = nullptr;
    std::string step;
    for (const JsonMember& m : v->members)
      if (is_at_or_before(m.place, place)) {
        inside = &m.value;
        step = escaped(m.name);
      }
    for (size_t i = 0; i < v->items.size(); i++)
      if (is_at_or_before(v->items[i].place, place)) {
        inside = &v->items[i];
        step = std::to_string(i);
      }
    if (inside) out += "/" + step;
    v = inside;
  }
  return out;
}

namespace {

bool same_members(const JsonValue& a, const JsonValue& b) {
  if (a.members.size() != b.members.size()) return false;
  const auto same = [](const JsonMember& m, const JsonMember& n) {
    return m.name == n.name && same_value(m.value, n.value);
  };
  if (std::ranges::equal(a.members, b.members, same)) return true;
  std::map<std::string_view, const JsonValue*> by_name;
  for (const JsonMember& m : b.members) by_name.emplace(m.name, &m.value);
  return by_name.size() == b.members.size() && std::ranges::all_of(a.members, [&](const JsonMember& m) {
           const auto at = by_name.find(m.name);
           return at != by_name.end() && same_value(m.value, *at->second);
         });
}

}  // namespace

bool same_value(const JsonValue& a, const JsonValue& b) {
  if (a.kind != b.kind) return false;
  switch (a.kind) {
    case JsonValue::Kind::null:
      return true;
    case JsonValue::Kind::boolean:
      return a.boolean == b.boolean;
    case JsonValue::Kind::integer:
      return a.integer == b.integer;
    case JsonValue::Kind::number:
      return a.number == b.number;
    case JsonValue::Kind::text:
      return a.text == b.text;
    case JsonValue::Kind::list:
      return std::ranges::equal(a.items, b.items, same_value);
    case JsonValue::Kind::object:
      break;
  }
  return same_members(a, b);
}

}  // namespace terrazzo
