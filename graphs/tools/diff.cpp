#include "graphs/tools/diff.h"

#include <algorithm>
#include <map>
#include <set>

#include <fmt/format.h>

#include "graphs/document/nodes.h"
#include "graphs/text/format.h"
#include "graphs/tools/rewrite.h"

namespace terrazzo {

namespace {

/// The sections of a graph with named entries, and the singular for messages.
const std::map<std::string, std::string> entry_names = {{"parameters", "parameter"}, {"presets", "preset"},
                                                        {"graphs", "graph"},         {"inputs", "input"},
                                                        {"nodes", "node"},           {"outputs", "output"}};

const JsonValue& no_entries() {
  static const JsonValue none = JsonValue::empty_object();
  return none;
}

/// The value without the order of its members.
std::string sorted(const JsonValue& v) {
  if (!v.is_object() && !v.is_list()) return compact(v);
  std::string out;
  std::map<std::string, std::string> members;
  for (const JsonMember& m : v.members) members[m.name] = sorted(m.value);
  for (const auto& [name, text] : members) out += in_quotes(name) + ":" + text + ",";
  for (const JsonValue& item : v.items) out += sorted(item) + ",";
  return fmt::format("{}{}{}", v.is_object() ? "{" : "[", out, v.is_object() ? "}" : "]");
}

std::string shown(const JsonValue& v) {
  constexpr size_t longest = 100;
  const std::string text = compact(v);
  return text.size() <= longest ? text : text.substr(0, longest) + "...";
}

class Comparison {
 public:
  std::vector<std::string> out;

  void graphs(const JsonValue& before, const JsonValue& after, const std::string& where) {
    const std::map<std::string, std::string> renamed = renamed_nodes(before, after);
    for (const auto& [from, to] : renamed)
      say(where, fmt::format("node {} is called {} now", in_quotes(from), in_quotes(to)));
    const JsonValue same_names = renamed.empty() ? before : with_names(before, renamed);
    std::set<std::string> keys;
    for (const JsonMember& m : same_names.members) keys.insert(m.name);
    for (const JsonMember& m : after.members) keys.insert(m.name);
    for (const std::string& key : keys) {
      const JsonValue* a = same_names.find(key);
      const JsonValue* b = after.find(key);
      const auto entry = entry_names.find(key);
      if (entry == entry_names.end())
        value(key, a, b, where);
      else
        entries(entry->second, a ? *a : no_entries(), b ? *b : no_entries(), where);
    }
  }

 private:
  void say(const std::string& where, const std::string& what) {
    out.push_back(where.empty() ? what : where + ": " + what);
  }

  void value(const std::string& name, const JsonValue* a, const JsonValue* b, const std::string& where) {
    if (!a)
      say(where, fmt::format("{} is given now: {}", name, shown(*b)));
    else if (!b)
      say(where, fmt::format("{} is no longer given; it was {}", name, shown(*a)));
    else if (a->is_object() && b->is_object())
      members(*a, *b, where.empty() ? name : where + ", " + name);
    else if (sorted(*a) != sorted(*b))
      say(where, fmt::format("{} {} -> {}", name, shown(*a), shown(*b)));
  }

  void members(const JsonValue& a, const JsonValue& b, const std::string& where) {
    for (const JsonMember& m : a.members) value(m.name, &m.value, b.find(m.name), where);
    for (const JsonMember& m : b.members)
      if (!a.find(m.name)) value(m.name, nullptr, &m.value, where);
  }

  void entries(const std::string& kind, const JsonValue& a, const JsonValue& b, const std::string& where) {
    const auto name_of = [&](const std::string& name) { return kind + " " + in_quotes(name); };
    const auto type_of = [](const JsonValue& v) {
      const JsonValue* type = v.find("type");
      return type && type->is_text() ? fmt::format(" ({})", type->text) : "";
    };
    for (const JsonMember& m : a.members) {
      const JsonValue* other = b.find(m.name);
      const std::string inside = where.empty() ? name_of(m.name) : where + ", " + name_of(m.name);
      if (!other)
        say(where, fmt::format("{}{} is gone", name_of(m.name), type_of(m.value)));
      else if (kind == "graph")
        graphs(m.value, *other, inside);
      else if (m.value.is_object() && other->is_object())
        members(m.value, *other, inside);
      else if (sorted(m.value) != sorted(*other))
        say(where, fmt::format("{} {} -> {}", name_of(m.name), shown(m.value), shown(*other)));
    }
    for (const JsonMember& m : b.members)
      if (!a.find(m.name))
        say(where, fmt::format("{}{} is new: {}", name_of(m.name), type_of(m.value), shown(m.value)));
  }

  /// Renamed nodes: removed and added nodes that are equal except for names.
  static std::map<std::string, std::string> renamed_nodes(const JsonValue& before, const JsonValue& after) {
    std::map<std::string, std::string> out;
    const JsonValue* a = before.find("nodes");
    const JsonValue* b = after.find("nodes");
    if (!a || !b) return out;
    // In topological order, so that readers of a renamed node are compared with the new name.
    for (bool found = true; found;) {
      found = false;
      const JsonValue known = out.empty() ? *a : *with_names(before, out).find("nodes");
      for (const JsonMember& m : known.members) {
        if (b->find(m.name)) continue;
        const auto twin = std::ranges::find_if(b->members, [&](const JsonMember& n) {
          const bool is_taken = known.find(n.name);
          return !is_taken && sorted(n.value) == sorted(m.value);
        });
        if (twin == b->members.end()) continue;
        out[m.name] = twin->name;
        found = true;
        break;
      }
    }
    return out;
  }

  /// The graph with nodes renamed, and all wires and expressions that name them.
  static JsonValue with_names(const JsonValue& graph, const std::map<std::string, std::string>& names) {
    const auto now = [&](const std::string& node) {
      const auto at = names.find(node);
      return at == names.end() ? node : at->second;
    };
    const TextChange change = renaming(now);
    JsonValue out = graph;
    for (const char* section : {"parameters", "nodes", "outputs"}) {
      JsonValue* entries = out.find(section);
      if (!entries) continue;
      for (JsonMember& m : entries->members) {
        if (std::string_view(section) == "nodes") m.name = now(m.name);
        m.value = rewritten_entry(m.value, change);
      }
    }
    return out;
  }
};

}  // namespace

std::vector<std::string> differences(const JsonValue& before, const JsonValue& after) {
  Comparison comparison;
  comparison.graphs(before, after, "");
  return std::move(comparison.out);
}

}  // namespace terrazzo
