#include <algorithm>

#include <fmt/format.h>

#include "core/base/suggest.h"
#include "graphs/document/nodes.h"
#include "graphs/edit/edit_context.h"
#include "graphs/tools/rewrite.h"

namespace terrazzo::edits {

namespace {

/// The object whose member is set: a node, or without a name the graph.
JsonValue& owner(EditContext& context, const std::string& key) {
  const std::string name = context.text_or_empty("node");
  if (name.empty()) {
    static const std::vector<std::string> keys = {"summary", "help", "seed"};
    if (std::ranges::find(keys, key) == keys.end())
      throw Error(fmt::format("a graph has no text or value {}{}", in_quotes(key), suggestion(key, keys)));
    return context.graph();
  }
  JsonValue& node = context.node(name);
  if (!node.is_object())
    throw Error(context.pointer({"nodes", name}), fmt::format("{} is not an object with a \"type\"", in_quotes(name)));
  return node;
}

std::string shown_target(EditContext& context, const std::string& key) {
  const std::string name = context.text_or_empty("node");
  return name.empty() ? key : name + "." + key;
}

bool erase_member(JsonValue& object, const std::string& name) {
  return std::erase_if(object.members, [&](const JsonMember& m) { return m.name == name; }) > 0;
}

/// Applies {"set": {..}} to an entry of a section, or removes it. A member that is null goes away.
void set_entry(EditContext& context, const std::string& section_name, const std::string& name) {
  JsonValue& section = context.section(section_name);
  if (const JsonValue* changes = context.change->find("set")) {
    if (changes->kind == JsonValue::Kind::null) {
      erase_member(section, name);
      if (section.members.empty()) erase_member(context.graph(), section_name);
      return;
    }
    if (!changes->is_object())
      throw Error(fmt::format("expected an object or null for \"set\", found {}", found(*changes)));
    JsonValue* entry = section.find(name);
    if (!entry || !entry->is_object()) section.set(name, JsonValue::empty_object());
    entry = section.find(name);
    for (const JsonMember& m : changes->members) {
      if (m.value.kind == JsonValue::Kind::null)
        erase_member(*entry, m.name);
      else
        entry->set(m.name, m.value);
    }
  }
}

/// Renames a graph's parameter or input where nodes of other graphs give it a value.
void rename_in_uses(EditContext& context, const std::string& from, const std::string& to) {
  if (context.level.empty()) return;
  const auto in_graph = [&](JsonValue& graph) {
    JsonValue* nodes = graph.find("nodes");
    if (!nodes) return;
    for (JsonMember& node : nodes->members)
      if (const JsonValue* type = node.value.find("type"); type && type->text == context.level)
        for (JsonMember& m : node.value.members)
          if (m.name == from) m.name = to;
  };
  in_graph(context.document);
  if (JsonValue* graphs = context.document.find("graphs"))
    for (JsonMember& m : graphs->members) in_graph(m.value);
}

/// Renames a parameter in the texts of a graph; others keep their bytes.
void rename_parameter(JsonValue& value, const std::string& from, const std::string& to) {
  if (value.is_text() && value.text.find(from) != value.text.npos) {
    bool is_named = false;
    const TextChange change{.wire = [](const std::string&, const std::string&, const JsonValue& text) { return text; },
                            .fact = [](const std::string& node) { return node; },
                            .parameter =
                                [&](const std::string& name) {
                                  is_named |= name == from;
                                  return JsonValue::of("$" + (name == from ? to : name));
                                }};
    try {
      const JsonValue changed = rewritten(value, change);
      if (is_named) value.text = changed.text;
    } catch (const Error&) {
      return;  // a faulty expression
    }
  }
  for (JsonValue& item : value.items) rename_parameter(item, from, to);
  for (JsonMember& m : value.members)
    if (m.name != "type" && m.name != "comment" && m.name != "help") rename_parameter(m.value, from, to);
}

void rename_declaration(EditContext& context, const std::string& from, const std::string& to) {
  JsonValue& parameters = context.section("parameters");
  if (!is_parameter_name(to))
    throw Error(fmt::format("{}: expected a name of letters, digits and _ that begins with a letter", in_quotes(to)));
  if (parameters.find(to))
    throw Error(context.pointer({"parameters", to}), fmt::format("there is a parameter {} already", in_quotes(to)));
  for (const char* key : {"parameters", "seed", "nodes", "outputs"})
    if (JsonValue* section = context.graph().find(key)) rename_parameter(*section, from, to);
  for (JsonMember& m : parameters.members)
    if (m.name == from) m.name = to;
  rename_in_uses(context, from, to);
  const TargetPart follow = [&](const std::string& level, std::string& name) {
    if (level == context.level && name == from) name = to;
    return true;
  };
  walk_preset_targets(context.document, {}, follow);
}

/// What gives a value to a graph's parameter that is removed: presets, and where the graph is used, nodes.
void remove_values(EditContext& context, const std::string& name) {
  // Before the nodes change: targets are read along them.
  const TargetPart stays = [&](const std::string& level, std::string& target) {
    return level != context.level || target != name;
  };
  const std::vector<std::string> presets = walk_preset_targets(context.document, {}, stays);
  const auto in_uses = [&](JsonValue& graph, const std::string& within) {
    JsonValue* uses = graph.find("nodes");
    if (!uses || context.level.empty()) return;
    for (JsonMember& node : uses->members) {
      const JsonValue* type = node.value.find("type");
      if (!type || type->text != context.level || !erase_member(node.value, name)) continue;
      context.out.taken.push_back(fmt::format("{}{} no longer sets {}", in_quotes(node.name), within, in_quotes(name)));
    }
  };
  in_uses(context.document, "");
  if (JsonValue* graphs = context.document.find("graphs"))
    for (JsonMember& m : graphs->members) in_uses(m.value, " in " + in_quotes(m.name));
  context.out.taken.insert(context.out.taken.end(), presets.begin(), presets.end());
}

}  // namespace

void set(EditContext& context) {
  const std::string& key = context.text("key");
  JsonValue& object = owner(context, key);
  const JsonValue& value = context.value("value");
  if (!object.find(key) && context.text_or_empty("node").empty()) {
    const auto at = std::ranges::find(object.members, "nodes", &JsonMember::name);
    object.members.insert(at, {key, {}, value});
  } else {
    object.set(key, value);
  }
  context.label("set " + shown_target(context, key));
}

void unset(EditContext& context) {
  const std::string& key = context.text("key");
  erase_member(owner(context, key), key);
  context.label("reset " + shown_target(context, key));
}

void set_parameter(EditContext& context) {
  const std::string& name = context.text("name");
  const std::string to = context.text_or_empty("rename");
  if (!is_parameter_name(name))
    throw Error(fmt::format("{}: expected a name of letters, digits and _ that begins with a letter", in_quotes(name)));
  const JsonValue* parameters = context.graph().find("parameters");
  if ((!context.change->find("set") || context.change->find("set")->kind == JsonValue::Kind::null) &&
      (!parameters || !parameters->find(name)))
    throw Error(fmt::format("the graph has no parameter {}", in_quotes(name)));
  set_entry(context, "parameters", name);
  if (const JsonValue* set = context.change->find("set"); set && set->kind == JsonValue::Kind::null)
    remove_values(context, name);
  if (!to.empty() && to != name) rename_declaration(context, name, to);
  context.label("change the parameter " + in_quotes(name));
}

void set_preset(EditContext& context) {
  const std::string& name = context.text("name");
  const std::string to = context.text_or_empty("rename");
  if (!context.level.empty())
    throw Error("presets belong to the whole graph: those of a subgraph are set where it is used");
  const JsonValue* presets = context.graph().find("presets");
  const JsonValue* set = context.change->find("set");
  if (name.empty()) throw Error("a preset needs a name");
  if ((!set || set->kind == JsonValue::Kind::null) && (!presets || !presets->find(name)))
    throw Error(fmt::format("the graph has no preset {}", in_quotes(name)));
  if (!to.empty() && to != name) {
    if (presets && presets->find(to))
      throw Error(context.pointer({"presets", to}), fmt::format("there is a preset {} already", in_quotes(to)));
    for (JsonMember& m : context.section("presets").members)
      if (m.name == name) m.name = to;
  }
  if (set) set_entry(context, "presets", to.empty() ? name : to);
  context.label("change the preset " + in_quotes(name));
}

void set_default(EditContext& context) {
  const std::string& name = context.text("name");
  JsonValue* parameters = context.graph().find("parameters");
  JsonValue* declared = parameters ? parameters->find(name) : nullptr;
  if (!declared || !declared->is_object()) {
    std::vector<std::string> names;
    if (parameters)
      for (const JsonMember& m : parameters->members) names.push_back(m.name);
    throw Error(fmt::format("the graph has no parameter {}{}", in_quotes(name), suggestion(name, names)));
  }
  const JsonValue& value = context.value("value");
  if (declared->find("default")) {
    declared->set("default", value);
  } else {
    const auto type = std::ranges::find(declared->members, "type", &JsonMember::name);
    declared->members.insert(type == declared->members.end() ? type : type + 1, {"default", {}, value});
  }
  context.label("set " + name);
}

void set_input(EditContext& context) {
  const std::string& name = context.text("name");
  if (!is_parameter_name(name))
    throw Error(fmt::format("{}: expected a name of letters, digits and _ that begins with a letter", in_quotes(name)));
  if (context.find_node(name))
    throw Error(context.pointer({"nodes", name}),
                fmt::format("a node is called {}, too; wires could not tell them apart", in_quotes(name)));
  set_entry(context, "inputs", name);
  context.label("change the input " + in_quotes(name));
}

void set_output(EditContext& context) {
  const std::string& name = context.text("name");
  const JsonValue& from = context.value("from");
  JsonValue& outputs = context.section("outputs");
  context.label("change the output " + in_quotes(name));
  if (from.kind == JsonValue::Kind::null) {
    erase_member(outputs, name);
    if (outputs.members.empty()) erase_member(context.graph(), "outputs");
    return;
  }
  if (!from.is_text()) throw Error(fmt::format("expected a wire for \"from\", found {}", found(from)));
  const LevelTypes types(context);
  const std::string text = wire_text(types, from.text);
  if (!types.graph().find_source(wire_parts(text).first))
    throw Error(
        fmt::format("the output {} cannot come from {}: there is no such node", in_quotes(name), in_quotes(text)));
  JsonValue* there = outputs.find(name);
  if (there && there->is_object())
    there->set("from", JsonValue::of(text));
  else
    outputs.set(name, JsonValue::of(text));
}

}  // namespace terrazzo::edits
