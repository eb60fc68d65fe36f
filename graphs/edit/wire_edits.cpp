#include <algorithm>
#include <map>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/base/suggest.h"
#include "graphs/document/wires.h"
#include "graphs/edit/edit_context.h"
#include "graphs/text/edit.h"

namespace terrazzo::edits {

namespace {

/// "node.port" as a wire; "@" may be missing.
JsonValue wire_of(const std::string& from) {
  return JsonValue::of(from.starts_with("@") ? from : "@" + from);
}

}  // namespace

void refuse_cycle(EditContext& context, const std::string& source, const std::string& reader,
                  const std::string& refused) {
  // From the source against the wires.
  std::map<std::string, std::string> read_by;
  std::vector<std::string> left = {source};
  read_by[source] = reader;
  while (!left.empty()) {
    const std::string node = left.back();
    left.pop_back();
    if (node == reader) break;
    const JsonValue* json = context.find_node(node);
    if (!json) continue;
    for (const std::string& named : named_nodes(*json))
      if (read_by.emplace(named, node).second) left.push_back(named);
  }
  if (source != reader && !read_by.contains(reader)) return;
  std::vector<std::string> cycle = {reader};
  do cycle.push_back(read_by.at(cycle.back()));
  while (cycle.back() != reader && cycle.size() < 100);
  throw Error(context.pointer({"nodes", reader}),
              fmt::format("{}: the wires would form a cycle: {}{}", refused, fmt::join(cycle, " -> "),
                          source == reader ? "; a node cannot read itself" : "; take one of these wires away first"));
}

namespace {

/// Throws Error if the type has no such port.
const Port* known_port(EditContext& context, const NodeType* type, const std::string& node, const std::string& port) {
  if (!type) return nullptr;
  const Port* found_port = type->find_input(port);
  if (found_port) return found_port;
  std::vector<std::string> names;
  for (const Port& p : type->inputs) names.push_back(p.name);
  throw Error(context.pointer({"nodes", node}),
              fmt::format("{} has no port {}{}", type->name, in_quotes(port),
                          names.empty() ? "; it takes no wires" : suggestion(port, names)));
}

/// Adds a wire to those of a list port.
JsonValue with_wire(EditContext& context, const JsonValue* there, const JsonValue& wire, int64_t index,
                    const std::vector<std::string>& path) {
  JsonValue list = there && there->is_list() ? *there : JsonValue();
  list.kind = JsonValue::Kind::list;
  if (there && is_wire(*there)) list.items.push_back(JsonValue::of(there->text));
  if (there && !there->is_list() && !is_wire(*there))
    throw Error(context.pointer(path),
                fmt::format("the wires of this port are {}; take that away first", found(*there)));
  const bool is_inside = index >= 0 && index < int64_t(list.items.size());
  list.items.insert(is_inside ? list.items.begin() + index : list.items.end(), wire);
  return list;
}

}  // namespace

std::string wire_text(const LevelTypes& types, const std::string& from) {
  const auto [node, port] = wire_parts(wire_of(from).text);
  const NodeType* type = types.of(node);
  const bool is_first = port.empty() || (type && !type->outputs.empty() && type->outputs.front().name == port);
  return "@" + node + (is_first ? "" : "." + port);
}

void put_wire(EditContext& context, const std::string& from, const std::string& to, const std::string& port,
              int64_t index) {
  const LevelTypes types(context);
  JsonValue& node = context.node(to);
  if (!node.is_object()) throw Error(context.pointer({"nodes", to}), fmt::format("{} is not a node", in_quotes(to)));
  const std::string text = wire_text(types, from);
  const auto [source, output] = wire_parts(text);
  const std::string refused =
      fmt::format("{} does not go into the port {} of {}", in_quotes(text), in_quotes(port), in_quotes(to));
  const Port* into = known_port(context, types.of(to), to, port);
  if (into) {
    const std::string fault = wire_fault(types.graph(), {source, output, {}, text}, to, *into);
    if (!fault.empty()) throw Error(context.pointer({"nodes", to, port}), refused + ": " + fault);
  } else if (!types.graph().find_source(source)) {
    throw Error(context.pointer({"nodes", to, port}),
                fmt::format("{}: there is no node {}", refused, in_quotes(source)));
  }
  refuse_cycle(context, source, to, refused);
  const JsonValue* there = node.find(port);
  const bool is_list = into ? into->list : there && there->is_list();
  const JsonValue wire = JsonValue::of(text);
  node.set(port, is_list ? with_wire(context, there, wire, index, {"nodes", to, port}) : wire);
}

void connect(EditContext& context) {
  const std::string &from = context.text("from"), &to = context.text("to"), &port = context.text("port");
  put_wire(context, from, to, port, context.position("index"));
  context.label(fmt::format("connect {} to {}", in_quotes(wire_parts(wire_of(from).text).first), in_quotes(to)));
}

void disconnect(EditContext& context) {
  const std::string &name = context.text("node"), &port = context.text("port");
  JsonValue& node = context.node(name);
  JsonValue* there = node.find(port);
  if (!there)
    throw Error(context.pointer({"nodes", name}),
                fmt::format("nothing is connected to the port {} of {}", in_quotes(port), in_quotes(name)));
  const int64_t index = context.position("index");
  bool is_left = false;
  if (there->is_list() && index >= 0) {
    if (index >= int64_t(there->items.size()))
      throw Error(context.pointer({"nodes", name, port}),
                  fmt::format("the port {} of {} has {} wires", in_quotes(port), in_quotes(name), there->items.size()));
    there->items.erase(there->items.begin() + index);
    is_left = !there->items.empty();
  }
  if (!is_left) std::erase_if(node.members, [&](const JsonMember& m) { return m.name == port; });
  context.label(fmt::format("disconnect {} of {}", in_quotes(port), in_quotes(name)));
}

}  // namespace terrazzo::edits
