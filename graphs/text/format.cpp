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
  explicit Writer(std::string unit) : unit_(std::move(unit)) {}

  std::string out;

  void document(const JsonValue& v) {
    comments(v, "");
    value(v, {0, ""}, 0, 0);
    out += '\n';
  }

  struct Depth {
    int of_graph;  ///< as in ValueSite
    std::string indent;
  };

  /// `behind`: the text after it on its line.
  void value(const JsonValue& v, const Depth& depth, size_t used, size_t behind) {
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

 private:
  void comments(const JsonValue& v, const std::string& indent) {
    for (const std::string& c : v.comments_before) out += (c.empty() ? "" : indent + c) + '\n';
  }

  void broken(const JsonValue& v, const Depth& depth) {
    const std::string indent = depth.indent + unit_;
    const size_t count = v.is_object() ? v.members.size() : v.items.size();
    out += v.is_object() ? "{\n" : "[\n";
    for (size_t i = 0; i < count; i++) {
      const JsonValue& entry = v.is_object() ? v.members[i].value : v.items[i];
      comments(entry, indent);
      const std::string name = v.is_object() ? in_quotes(v.members[i].name) + ": " : "";
      out += indent + name;
      const int of_graph = depth_inside(depth.of_graph, v.is_object() ? v.members[i].name : "");
      value(entry, {of_graph, indent}, indent.size() + name.size(), 1);
      if (i + 1 < count) out += ',';
      if (!entry.comment_after.empty()) out += "  " + entry.comment_after;
      out += '\n';
    }
    for (const std::string& c : v.comments_inside) out += (c.empty() ? "" : indent + c) + '\n';
    out += depth.indent + (v.is_object() ? "}" : "]");
  }

  std::string unit_;
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

int depth_inside(int of_graph, std::string_view name) {
  return of_graph == 0 && name == "graphs" ? -1 : of_graph + 1;
}

std::string formatted_at(const JsonValue& value, const ValueSite& site) {
  Writer writer(site.unit);
  writer.value(value, {site.of_graph, site.indent}, site.used, site.behind);
  return std::move(writer.out);
}

std::string formatted(const JsonValue& document) {
  Writer writer("  ");
  writer.document(document);
  return std::move(writer.out);
}

}  // namespace terrazzo
