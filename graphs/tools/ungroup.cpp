#include <algorithm>
#include <map>

#include <fmt/format.h>

#include "graphs/tools/grouping.h"
#include "graphs/tools/rewrite.h"

namespace terrazzo {

namespace {

class Ungrouping {
 public:
  Ungrouping(JsonValue& document, const Subgraph& graph, const std::string& node)
      : document_(document), graph_(graph), node_(node), use_(*document.find("nodes")->find(node)) {}

  void run() {
    for (const char* key : {"foreach", "mute"})
      if (use_.find(key))
        throw Error(fmt::format("the node {} has \"{}\", which its nodes would each need; remove it first",
                                in_quotes(node_), key));
    name_nodes();
    JsonValue* nodes = document_.find("nodes");
    std::vector<JsonMember> inside;
    for (const JsonMember& m : graph_.json->find("nodes")->members)
      inside.push_back({names_.at(m.name), {}, inlined(m.value)});
    if (!inside.empty() && inside.front().value.comments_before.empty())
      inside.front().value.comments_before = use_.comments_before;
    if (JsonValue* parameters = document_.find("parameters"))
      for (JsonMember& m : parameters->members) m.value = rewritten_outside(m.value);
    for (JsonMember& m : nodes->members)
      if (m.name != node_) m.value = rewritten_outside(m.value);
    if (JsonValue* outputs = document_.find("outputs"))
      for (JsonMember& m : outputs->members) m.value = rewritten_outside(m.value);
    rename_in_presets();
    const auto at = std::ranges::find(nodes->members, node_, &JsonMember::name);
    const auto next = nodes->members.erase(at);
    nodes->members.insert(next, std::make_move_iterator(inside.begin()), std::make_move_iterator(inside.end()));
    remove_unused();
  }

 private:
  void name_nodes() {
    std::set<std::string> taken;
    for (const JsonMember& m : document_.find("nodes")->members)
      if (m.name != node_) taken.insert(m.name);
    for (const JsonMember& m : graph_.json->find("nodes")->members) {
      std::string name = m.name;
      if (taken.contains(name)) name = node_ + "_" + m.name;
      for (int i = 2; !taken.insert(name).second; i++) name = fmt::format("{}_{}_{}", node_, m.name, i);
      names_[m.name] = name;
    }
  }

  /// The value of a parameter in the use, or its default, as written in the enclosing document.
  JsonValue parameter(const std::string& name) {
    if (const JsonValue* given = use_.find(name)) return *given;
    const JsonValue* parameters = graph_.json->find("parameters");
    const JsonValue* declared = parameters ? parameters->find(name) : nullptr;
    if (!declared) return JsonValue::of("$" + name);  // a variable of the node's own loop
    const JsonValue* fallback = declared->find("default");
    if (!fallback) throw Error(fmt::format("the parameter {} of {} has no value", in_quotes(name), in_quotes(node_)));
    return fallback->is_text() && is_expression(fallback->text) ? rewritten(*fallback, inside()) : *fallback;
  }

  const JsonValue* input(const std::string& name) const {
    const bool is_input = std::ranges::any_of(graph_.inputs, [&](const Port& p) { return p.name == name; });
    return is_input ? use_.find(name) : nullptr;
  }

  bool is_input(const std::string& name) const {
    return std::ranges::any_of(graph_.inputs, [&](const Port& p) { return p.name == name; });
  }

  TextChange inside() {
    return {.wire =
                [this](const std::string& from, const std::string& port, const JsonValue& text) {
                  if (const auto name = names_.find(from); name != names_.end())
                    return JsonValue::of("@" + name->second + (port.empty() ? "" : "." + port));
                  const JsonValue* outer = input(from);
                  return outer ? *outer : text;
                },
            .fact =
                [this](const std::string& from) {
                  if (const auto name = names_.find(from); name != names_.end()) return name->second;
                  const JsonValue* outer = input(from);
                  if (!outer || !is_wire(*outer))
                    throw Error(fmt::format(
                        "an expression in it queries its input {}, which does not come from exactly one node",
                        in_quotes(from)));
                  return wire_parts(outer->text).first;
                },
            .parameter = [this](const std::string& name) { return parameter(name); }};
  }

  JsonValue inlined(const JsonValue& node) {
    JsonValue out = node;
    // Ports that read an open input stay open.
    std::erase_if(out.members, [&](const JsonMember& m) {
      if (!is_wire(m.value)) return false;
      const std::string from = wire_parts(m.value.text).first;
      return is_input(from) && !use_.find(from);
    });
    return rewritten_entry(out, inside());
  }

  /// The wire of an output, in terms of the document.
  JsonValue output(const std::string& port) {
    for (const GraphOutput& o : graph_.outputs)
      if (port.empty() || o.port.name == port) return rewritten(o.from, inside());
    throw Error(fmt::format("{} has no output {}", in_quotes(node_), in_quotes(port)));
  }

  JsonValue rewritten_outside(const JsonValue& value) {
    const TextChange change{.wire = [&](const std::string& from, const std::string& port,
                                        const JsonValue& text) { return from == node_ ? output(port) : text; },
                            .fact =
                                [&](const std::string& from) {
                                  if (from != node_) return from;
                                  const JsonValue wire = output("");
                                  if (!is_wire(wire))
                                    throw Error("an expression outside queries an output that an expression chooses");
                                  return wire_parts(wire.text).first;
                                },
                            .parameter = [](const std::string& name) { return JsonValue::of("$" + name); }};
    return rewritten_entry(value, change);
  }

  /// "walls/layout.quality" as "layout.quality".
  void rename_in_presets() {
    JsonValue* presets = document_.find("presets");
    if (!presets) return;
    for (JsonMember& preset : presets->members) {
      JsonValue* set = preset.value.find("set");
      if (!set) continue;
      for (JsonMember& m : set->members) {
        if (m.name.starts_with(node_ + "."))
          throw Error(fmt::format("the preset {} sets {}, which would no longer exist; remove that first",
                                  in_quotes(preset.name), in_quotes(m.name)));
        if (!m.name.starts_with(node_ + "/")) continue;
        const std::string rest = m.name.substr(node_.size() + 1);
        const std::string inner = rest.substr(0, rest.find_first_of("./["));
        if (const auto name = names_.find(inner); name != names_.end())
          m.name = name->second + rest.substr(inner.size());
      }
    }
  }

  void remove_unused() {
    JsonValue* graphs = document_.find("graphs");
    if (!graphs || !graphs->find(graph_.title)) return;
    const auto uses = [&](const JsonValue& graph) {
      const JsonValue* nodes = graph.find("nodes");
      return nodes && std::ranges::any_of(nodes->members, [&](const JsonMember& m) {
               const JsonValue* type = m.value.find("type");
               return type && type->text == graph_.title;
             });
    };
    if (uses(document_)) return;
    for (const JsonMember& m : graphs->members)
      if (uses(m.value)) return;
    std::erase_if(graphs->members, [&](const JsonMember& m) { return m.name == graph_.title; });
    if (graphs->members.empty())
      std::erase_if(document_.members, [](const JsonMember& m) { return m.name == "graphs"; });
  }

  JsonValue& document_;
  const Subgraph& graph_;
  const std::string& node_;
  const JsonValue use_;  // by value: the document changes
  std::map<std::string, std::string> names_;
};

}  // namespace

void detail::ungroup(JsonValue& document, const Subgraph& graph, const std::string& node) {
  Ungrouping(document, graph, node).run();
}

}  // namespace terrazzo
