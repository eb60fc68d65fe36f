#include "graphs/text/format.h"

namespace terrazzo {

namespace {

constexpr size_t line_width = 120;

bool has_comments(const JsonValue& v) {
  return !v.comments_before.empty() || !v.comment_after.empty() || !v.comments_inside.empty();
}

bool contains_comments(const JsonValue& v) {
  for (const JsonValue& item : v.items)
    if (has_comments(item) || contains_comments(item)) return true;
  for (const JsonMember& m : v.members)
    if (has_comments(m.value) || contains_comments(m.value)) return true;
  return !v.comments_inside.empty();
}

class Writer {
 public:
  std::string out;

  void document(const JsonValue& v) {
    comments(v, "");
    value(v, {0, 0}, 0, 0);
    out += '\n';
  }

 private:
  struct Depth {
    int of_graph;  ///< 0 is a graph, 1 its sections, 2 their entries
    int indent;
  };

  /// `behind`: the text after it on its line.
  void value(const JsonValue& v, Depth depth, size_t used, size_t behind) {
    if (!v.is_object() && !v.is_list()) {
      out += compact(v);
      return;
    }
    const bool is_section = depth.of_graph <= 0 || (depth.of_graph == 1 && v.is_object() && !v.members.empty());
    if (!is_section && !contains_comments(v)) {
      const std::string line = compact(v);
      if (used + line.size() + behind <= line_width) {
        out += line;
        return;
      }
    }
    broken(v, depth);
  }

  void comments(const JsonValue& v, const std::string& indent) {
    for (const std::string& c : v.comments_before) out += (c.empty() ? "" : indent + c) + '\n';
  }

  void broken(const JsonValue& v, Depth depth) {
    const std::string indent(2 * (depth.indent + 1), ' ');
    const size_t count = v.is_object() ? v.members.size() : v.items.size();
    out += v.is_object() ? "{\n" : "[\n";
    for (size_t i = 0; i < count; i++) {
      const JsonValue& entry = v.is_object() ? v.members[i].value : v.items[i];
      comments(entry, indent);
      const std::string name = v.is_object() ? in_quotes(v.members[i].name) + ": " : "";
      out += indent + name;
      const bool holds_graphs = depth.of_graph == 0 && v.is_object() && v.members[i].name == "graphs";
      const int of_graph = holds_graphs ? -1 : depth.of_graph + 1;
      value(entry, {of_graph, depth.indent + 1}, indent.size() + name.size(), 1);
      if (i + 1 < count) out += ',';
      if (!entry.comment_after.empty()) out += "  " + entry.comment_after;
      out += '\n';
    }
    for (const std::string& c : v.comments_inside) out += (c.empty() ? "" : indent + c) + '\n';
    out += indent.substr(2) + (v.is_object() ? "}" : "]");
  }
};

}  // namespace

std::string compact(const JsonValue& v) {
  switch (v.kind) {
    case JsonValue::Kind::null:
      return "null";
    case JsonValue::Kind::boolean:
      return v.boolean ? "true" : "false";
    case JsonValue::Kind::integer:
    case JsonValue::Kind::number:
      return v.text;
    case JsonValue::Kind::text:
      return in_quotes(v.text);
    default:
      break;
  }
  std::string out = v.is_object() ? "{" : "[";
  bool first = true;
  const auto separate = [&] {
    if (!first) out += ", ";
    first = false;
  };
  for (const JsonValue& item : v.items) {
    separate();
    out += compact(item);
  }
  for (const JsonMember& m : v.members) {
    separate();
    out += in_quotes(m.name) + ": " + compact(m.value);
  }
  return out + (v.is_object() ? "}" : "]");
}

std::string formatted(const JsonValue& document) {
  Writer writer;
  writer.document(document);
  return std::move(writer.out);
}

}  // namespace terrazzo
