#include <algorithm>

#include <fmt/format.h>

#include "core/base/suggest.h"
#include "core/base/text.h"
#include "graphs/document/wires.h"
#include "graphs/edit/edit_context.h"
#include "graphs/text/edit.h"
#include "graphs/text/stock_graphs.h"
#include "nodes/common/registry.h"

namespace terrazzo::edits {

namespace {

/// "stock:material" as "material", "parts/walls.json" as "walls".
std::string name_from_type(const std::string& type) {
  std::string out = type;
  if (is_stock(out)) out = out.substr(stock_prefix.size());
  if (out.ends_with(".json")) out = std::filesystem::path(out).stem().string();
  for (char& c : out)
    if (!is_word(c) && c != '-') c = '_';
  return out.empty() ? "node" : out;
}

void check_name(EditContext& context, const std::string& name) {
  if (!is_node_name(name)) throw Error(fmt::format("{}: expected a name of letters, digits, _ and -", in_quotes(name)));
  if (context.find_node(name))
    throw Error(context.pointer({"nodes", name}), fmt::format("there is a node {} already", in_quotes(name)));
  const JsonValue* inputs = context.graph().find("inputs");
  if (inputs && inputs->find(name))
    throw Error(context.pointer({"inputs", name}),
                fmt::format("there is an input {} already; wires could not tell them apart", in_quotes(name)));
}

void check_type(EditContext& context, const std::string& type) {
  if (find_node_type(type) || Subgraphs::is_file(type)) return;
  std::vector<std::string> names;
  for (const NodeType& t : node_types()) names.push_back(t.name);
  if (const JsonValue* graphs = context.document.find("graphs"))
    for (const JsonMember& m : graphs->members) {
      if (m.name == type && m.name == context.level)
        throw Error(fmt::format("the graph {} cannot be part of itself", in_quotes(type)));
      if (m.name == type) return;
      names.push_back(m.name);
    }
  throw Error(fmt::format("there is no node type {}{}", in_quotes(type), did_you_mean(type, names)));
}

/// Connects the node to the first output that fits; leaves it alone if none does.
void connect_behind(EditContext& context, const std::string& name, const JsonValue& behind) {
  const JsonValue* source = behind.find("node");
  if (!source || !source->is_text()) return;
  const JsonValue* wanted = behind.find("output");
  LevelTypes types(context);
  const NodeType *from = types.of(source->text), *to = types.of(name);
  if (!from || !to) return;
  for (const Port& output : from->outputs) {
    if (wanted && wanted->is_text() && !wanted->text.empty() && wanted->text != output.name) continue;
    if (const Port* input = fitting_input(*to, output.type))
      return put_wire(context, source->text + "." + output.name, name, input->name, -1);
  }
}

}  // namespace

const Port* fitting_input(const NodeType& node, ValueType wire) {
  for (const Port& p : node.inputs)
    if (p.type == wire) return &p;
  for (const Port& p : node.inputs)
    if (converts(wire, p.type)) return &p;
  return nullptr;
}

void add(EditContext& context) {
  const std::string& type = context.text("type");
  check_type(context, type);
  const std::string wanted = context.text_or_empty("name");
  const std::string name = wanted.empty() ? context.free_name(name_from_type(type)) : wanted;
  check_name(context, name);
  JsonValue node = JsonValue::empty_object();
  node.set("type", JsonValue::of(type));
  if (const JsonValue* values = context.change->find("values"))
    for (const JsonMember& m : values->members)
      if (m.name != "type") node.members.push_back({m.name, {}, m.value});
  JsonValue& nodes = context.section("nodes");
  const JsonValue* behind = context.change->find("behind");
  const JsonValue* source = behind ? behind->find("node") : nullptr;
  auto at = source ? std::ranges::find(nodes.members, source->text, &JsonMember::name) : nodes.members.end();
  if (at != nodes.members.end()) ++at;
  nodes.members.insert(at, {name, {}, std::move(node)});
  if (behind) connect_behind(context, name, *behind);
  context.out.added.push_back(name);
  context.label("add " + in_quotes(name));
}

void remove(EditContext& context) {
  const std::vector<std::string> names = context.texts("nodes");
  for (const std::string& name : names) context.node(name);
  const auto is_gone = [&](const std::string& node) { return std::ranges::find(names, node) != names.end(); };
  std::vector<std::string>& taken = context.out.taken;
  const TargetPart stays = [&](const std::string& level, std::string& node) {
    return level != context.level || !is_gone(node);
  };
  for (std::string& preset : walk_preset_targets(context.document, stays, {})) taken.push_back(std::move(preset));
  JsonValue& nodes = context.section("nodes");
  std::erase_if(nodes.members, [&](const JsonMember& m) { return is_gone(m.name); });
  for (JsonMember& m : nodes.members)
    for (const std::string& port : without_wires(m.value, is_gone))
      taken.push_back(fmt::format("a wire into the port {} of {}", in_quotes(port), in_quotes(m.name)));
  if (JsonValue* outputs = context.graph().find("outputs"))
    std::erase_if(outputs->members, [&](const JsonMember& m) {
      JsonValue output = JsonValue::empty_object();
      output.members.push_back(m);
      if (m.value.is_object()) output = m.value;
      const bool goes = !without_wires(output, is_gone).empty();
      if (goes) taken.push_back(fmt::format("the output {} of the graph", in_quotes(m.name)));
      return goes;
    });
  context.label(names.size() == 1 ? "remove " + in_quotes(names.front())
                                  : fmt::format("remove {} nodes", names.size()));
}

void rename(EditContext& context) {
  const std::string from = context.text("node"), to = context.text("to");
  context.node(from);
  if (from == to) return;
  check_name(context, to);
  const TargetPart follow = [&](const std::string& level, std::string& node) {
    if (level == context.level && node == from) node = to;
    return true;
  };
  walk_preset_targets(context.document, follow, {});
  const std::map<std::string, std::string> names = {{from, to}};
  for (const char* key : {"parameters", "nodes", "outputs"})
    if (JsonValue* entries = context.graph().find(key))
      for (JsonMember& m : entries->members) rename_nodes(m.value, names);
  if (JsonValue* seed = context.graph().find("seed")) rename_nodes(*seed, names);
  for (JsonMember& m : context.section("nodes").members)
    if (m.name == from) m.name = to;
  context.out.renamed.push_back({context.level, from, to});
  context.label(fmt::format("rename {} to {}", in_quotes(from), in_quotes(to)));
}

void insert(EditContext& context) {
  const std::string name = context.text("node");
  const JsonValue& wire = context.value("wire");
  const JsonValue *reader = wire.find("node"), *port = wire.find("port"), *index = wire.find("index");
  if (!reader || !reader->is_text() || !port || !port->is_text())
    throw Error("expected the wire as {\"node\": ..., \"port\": ...}");
  context.node(name);
  if (name == reader->text) throw Error("a node cannot be put into a wire of its own");
  const JsonValue* there = context.node(reader->text).find(port->text);
  const int64_t position = index && index->kind == JsonValue::Kind::integer ? index->integer : 0;
  if (there && there->is_list()) there = position < int64_t(there->items.size()) ? &there->items[position] : nullptr;
  if (!there || !is_wire(*there))
    throw Error(fmt::format("there is no wire into the port {} of {}", in_quotes(port->text), in_quotes(reader->text)));
  const std::string from = there->text;
  LevelTypes types(context);
  const auto [source, output] = wire_parts(from);
  const NodeType *source_type = types.of(source), *type = types.of(name), *reader_type = types.of(reader->text);
  if (!source_type || !type || !reader_type) throw Error("a type along the wire is unknown");
  const Port* wired = output.empty() && !source_type->outputs.empty() ? &source_type->outputs.front()
                                                                      : source_type->find_output(output);
  const Port* into = reader_type->find_input(port->text);
  if (!wired || !into) throw Error("the wire is faulty; repair it first");
  const Port* input = fitting_input(*type, wired->type);
  const auto fits = [&](const Port& p) { return converts(p.type, into->type); };
  const auto out = std::ranges::find_if(type->outputs, fits);
  if (!input || out == type->outputs.end())
    throw Error(
        context.pointer({"nodes", name}),
        fmt::format("{} does not fit between {} and {}: it would have to take a wire of type {} and make one of "
                    "type {}",
                    in_quotes(name), in_quotes(source), in_quotes(reader->text), name_of(wired->type),
                    name_of(into->type)));
  put_wire(context, from, name, input->name, -1);
  refuse_cycle(context, name, reader->text,
               fmt::format("{} does not fit before {}", in_quotes(name), in_quotes(reader->text)));
  JsonValue& changed = *context.node(reader->text).find(port->text);
  const std::string text = wire_text(types, name + "." + out->name);
  if (changed.is_list())
    changed.items[position] = JsonValue::of(text);
  else
    changed = JsonValue::of(text);
  context.label(fmt::format("put {} before {}", in_quotes(name), in_quotes(reader->text)));
}

}  // namespace terrazzo::edits
