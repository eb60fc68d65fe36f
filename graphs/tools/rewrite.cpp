#include "graphs/tools/rewrite.h"

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/base/text.h"
#include "graphs/document/nodes.h"
#include "graphs/expression/expression.h"
#include "graphs/text/format.h"
#include "graphs/values/substitution.h"

namespace terrazzo {

namespace {

/// A text split into plain parts and names of parameters.
struct Part {
  std::string text;
  bool is_parameter = false;
};

std::vector<Part> parts_of(const std::string& text) {
  std::vector<Part> out;
  const auto add = [&](char c) {
    if (out.empty() || out.back().is_parameter) out.push_back({});
    out.back().text += c;
  };
  for (size_t at = 0; at < text.size();) {
    const std::optional<ParameterReference> reference = text[at] == '$' ? reference_at(text, at) : std::nullopt;
    if (reference) {
      out.push_back({reference->name, true});
      at = reference->end;
    } else {
      add(text[at]);
      if (text.compare(at, 2, "$$") == 0) add(text[++at]);
      at++;
    }
  }
  return out;
}

std::string without_doubled_dollars(const std::string& text) {
  std::string out;
  for (size_t at = 0; at < text.size(); at++) {
    out += text[at];
    if (text.compare(at, 2, "$$") == 0) at++;
  }
  return out;
}

std::string quoted(const std::string& text) {
  if (text.find('\'') != text.npos)
    throw Error(fmt::format("an expression has no way to write the text {}", in_quotes(text)));
  return "'" + text + "'";
}

std::string wire_text(const JsonValue& wire) {
  if (!wire.is_text()) throw Error("an expression chooses one wire, but there would be several here");
  return wire.text;
}

class Rewriter {
 public:
  explicit Rewriter(const TextChange& change) : change_(change) {}

  JsonValue value(const JsonValue& v) const {
    if (v.is_text()) return text(v);
    JsonValue out = v;
    out.items.clear();
    for (const JsonValue& item : v.items) {
      JsonValue changed = value(item);
      // A wire that is replaced by several is spliced into the list.
      if (is_wire(item) && changed.is_list())
        out.items.insert(out.items.end(), changed.items.begin(), changed.items.end());
      else
        out.items.push_back(std::move(changed));
    }
    for (JsonMember& m : out.members) m.value = value(m.value);
    return out;
  }

 private:
  /// Takes over the comments of the replaced value.
  static JsonValue in_place_of(const JsonValue& old, JsonValue changed) {
    changed.comments_before = old.comments_before;
    changed.comment_after = old.comment_after;
    return changed;
  }

  JsonValue text(const JsonValue& v) const {
    if (is_wire(v)) {
      const auto [node, port] = wire_parts(v.text);
      return in_place_of(v, change_.wire(node, port, v));
    }
    if (is_expression(v.text)) return in_place_of(v, JsonValue::of("=" + expression(v.text.substr(1))));
    const std::vector<Part> parts = parts_of(v.text);
    if (parts.size() == 1 && parts.front().is_parameter) return in_place_of(v, change_.parameter(parts.front().text));
    return in_place_of(v, JsonValue::of(joined(parts)));
  }

  std::string joined(const std::vector<Part>& parts) const {
    std::string out, sum;
    bool is_sum = false;
    for (size_t i = 0; i < parts.size(); i++) {
      const Part& p = parts[i];
      const JsonValue value = p.is_parameter ? change_.parameter(p.text) : JsonValue::of(p.text);
      const bool is_text = value.is_text();
      is_sum |= p.is_parameter && is_text && is_expression(value.text);
      const bool needs_brace = p.is_parameter && i + 1 < parts.size() && is_word(parts[i + 1].text.front());
      out += !is_text ? spelled(value) : needs_brace ? braced(value.text) : value.text;
      if (!sum.empty()) sum += " + ";
      sum += p.is_parameter ? in_expression(value) : quoted(without_doubled_dollars(p.text));
    }
    return is_sum ? "=" + sum : out;
  }

  /// "$name" as "${name}", so that letters may follow.
  static std::string braced(const std::string& text) {
    const std::optional<ParameterReference> reference = reference_at(text, 0);
    return reference && reference->end == text.size() ? "${" + reference->name + "}" : text;
  }

  static std::string spelled(const JsonValue& value) {
    if (value.is_list() && value.items.size() == 2)
      return fmt::format("{}x{}", value.items[0].text, value.items[1].text);
    return compact(value);
  }

  std::string expression(const std::string& text) const {
    std::string out;
    char before = 0;  // the last character that is no space
    for (size_t at = 0; at < text.size();) {
      const char c = text[at];
      size_t end = at + 1;
      if (c == '\'') {
        end = std::min(text.find('\'', at + 1), text.size() - 1) + 1;
        out += literal(text.substr(at, end - at));
      } else if (c == '@') {
        while (end < text.size() && (is_word(text[end]) || text[end] == '-')) end++;
        out += "@" + change_.fact(text.substr(at + 1, end - at - 1));
        const size_t members = end;
        while (end < text.size() && (is_word(text[end]) || text[end] == '.')) end++;
        out += text.substr(members, end - members);
      } else if (is_digit(c) || (c == '.' && end < text.size() && is_digit(text[end]))) {
        while (end < text.size() && (is_word(text[end]) || text[end] == '.')) end++;
        out += text.substr(at, end - at);
      } else if (is_letter(c)) {
        while (end < text.size() && is_word(text[end])) end++;
        const std::string name = text.substr(at, end - at);
        const size_t next = text.find_first_not_of(" \t\r\n", end);
        const bool is_call = next != text.npos && text[next] == '(';
        const bool is_name = before != '.' && !is_call && name != "true" && name != "false";
        out += is_name ? in_expression(change_.parameter(name)) : name;
      } else {
        out += c;
      }
      if (c != ' ') before = text[end - 1];
      at = end;
    }
    return out;
  }

  /// The literal 'text', which may be a wire.
  std::string literal(const std::string& text) const {
    const JsonValue inside = JsonValue::of(text.substr(1, text.size() - 2));
    if (!is_wire(inside)) return text;
    const auto [node, port] = wire_parts(inside.text);
    return quoted(wire_text(change_.wire(node, port, inside)));
  }

  const TextChange& change_;
};

}  // namespace

std::string in_expression(const JsonValue& value) {
  if (value.is_object()) throw Error("an expression has no way to write a map");
  if (value.is_list()) {
    std::string out = "[";
    for (const JsonValue& item : value.items) out += (out.size() > 1 ? ", " : "") + in_expression(item);
    return out + "]";
  }
  if (value.is_number()) return value.text.starts_with('-') ? "(" + value.text + ")" : value.text;
  if (!value.is_text()) return compact(value);
  if (is_expression(value.text)) return "(" + value.text.substr(1) + ")";
  const std::vector<Part> parts = parts_of(value.text);
  std::string out;
  for (const Part& p : parts)
    out += (out.empty() ? "" : " + ") + (p.is_parameter ? p.text : quoted(without_doubled_dollars(p.text)));
  return parts.size() > 1 ? "(" + out + ")" : parts.empty() ? "''" : out;
}

TextChange renaming(std::function<std::string(const std::string& node)> now) {
  return {.wire = [now](const std::string& node, const std::string& port,
                        const JsonValue&) { return JsonValue::of("@" + now(node) + (port.empty() ? "" : "." + port)); },
          .fact = now,
          .parameter = [](const std::string& name) { return JsonValue::of("$" + name); }};
}

JsonValue rewritten(const JsonValue& value, const TextChange& change) {
  return Rewriter(change).value(value);
}

JsonValue rewritten_entry(const JsonValue& entry, const TextChange& change) {
  if (!entry.is_object()) return rewritten(entry, change);
  JsonValue out = entry;
  for (JsonMember& m : out.members)
    if (m.name != "type" && m.name != "comment" && m.name != "help") m.value = rewritten(m.value, change);
  return out;
}

}  // namespace terrazzo
