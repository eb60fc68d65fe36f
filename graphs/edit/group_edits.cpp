#include <algorithm>
#include <set>

#include <fmt/format.h>

#include "core/base/suggest.h"
#include "graphs/edit/edit_context.h"
#include "graphs/text/edit.h"
#include "graphs/text/format.h"
#include "graphs/tools/grouping.h"

namespace terrazzo::edits {

namespace {

bool uses_type(const JsonValue& graph, const std::string& type) {
  const JsonValue* nodes = graph.find("nodes");
  return nodes && std::ranges::any_of(nodes->members, [&](const JsonMember& m) {
           const JsonValue* t = m.value.find("type");
           return t && t->is_text() && t->text == type;
         });
}

JsonValue* find_graph(JsonValue& document, const std::string& name) {
  JsonValue* graphs = document.find("graphs");
  return graphs ? graphs->find(name) : nullptr;
}

/// Nodes that other nodes are made of, as an object {"nodes": .., "graphs": ..}.
struct Clip {
  JsonValue nodes = JsonValue::empty_object();
  JsonValue graphs = JsonValue::empty_object();
};

/// Adds the graphs of the document that these nodes are made of.
void add_graphs(const JsonValue& document, const JsonValue& nodes, JsonValue& graphs) {
  const JsonValue* all = document.find("graphs");
  if (!all) return;
  for (const JsonMember& m : nodes.members) {
    const JsonValue* type = m.value.find("type");
    const JsonValue* graph = type && type->is_text() ? all->find(type->text) : nullptr;
    if (!graph || graphs.find(type->text)) continue;
    graphs.members.push_back({type->text, {}, *graph});
    if (const JsonValue* inner = graph->find("nodes")) add_graphs(document, *inner, graphs);
  }
}

/// Reads the text of a clipboard: what copied_nodes writes, a document, or nodes by name.
Clip read_clip(const std::string& text) {
  const ParsedJson parsed = parse_json(text);
  const auto refuse = [](const std::string& why) { return Error("the clipboard holds no nodes: " + why); };
  if (!parsed.value) throw refuse(parsed.problems.front().message);
  if (!parsed.value->is_object()) throw refuse("expected an object, found " + found(*parsed.value));
  Clip out;
  const JsonValue* nodes = parsed.value->find("nodes");
  const bool is_wrapped = nodes && nodes->is_object() && !nodes->find("type");
  for (const JsonMember& m : (is_wrapped ? *nodes : *parsed.value).members) {
    if (!m.value.is_object() || !m.value.find("type"))
      throw refuse(in_quotes(m.name) + " is not an object with a \"type\"");
    if (!is_node_name(m.name)) throw refuse(in_quotes(m.name) + " is no name of letters, digits, _ and -");
    if (!out.nodes.find(m.name)) out.nodes.members.push_back({m.name, {}, m.value});
  }
  if (out.nodes.members.empty()) throw refuse("it is an empty object");
  const JsonValue* graphs = is_wrapped ? parsed.value->find("graphs") : nullptr;
  if (graphs && graphs->is_object())
    for (const JsonMember& m : graphs->members) out.graphs.members.push_back({m.name, {}, m.value});
  return out;
}

void retype(JsonValue& nodes, const std::string& from, const std::string& to) {
  for (JsonMember& m : nodes.members)
    if (JsonValue* type = m.value.find("type"); type && type->text == from) *type = JsonValue::of(to);
}

/// Adds the graphs of a clipboard that the document lacks; those that differ get other names.
void add_clip_graphs(EditContext& context, Clip& clip) {
  std::set<std::string> used;
  for (size_t i = 0; i < clip.graphs.members.size(); i++) {
    const std::string name = clip.graphs.members[i].name;
    const JsonValue* there = find_graph(context.document, name);
    if (there && same_value(*there, clip.graphs.members[i].value)) continue;
    std::string now = name;
    for (int n = 2; find_graph(context.document, now) || used.contains(now); n++) now = fmt::format("{}_{}", name, n);
    used.insert(now);
    clip.graphs.members[i].name = now;
    if (now == name) continue;
    retype(clip.nodes, name, now);
    for (JsonMember& m : clip.graphs.members)
      if (JsonValue* inner = m.value.find("nodes")) retype(*inner, name, now);
  }
  if (clip.graphs.members.empty()) return;
  const std::string level = std::exchange(context.level, "");
  JsonValue& graphs = context.section("graphs");
  for (const JsonMember& m : clip.graphs.members)
    if (!graphs.find(m.name)) graphs.members.push_back(m);
  context.level = level;
}

/// The graph of the level as a document of its own, for the functions of graphs/tools.
JsonValue as_document(EditContext& context) {
  return context.level.empty() ? context.document : context.graph();
}

/// Puts a changed graph back into its level. `made`: a new graph in it, which belongs to the document.
void put_back(EditContext& context, JsonValue changed, const std::string& made) {
  if (context.level.empty()) {
    context.document = std::move(changed);
    return;
  }
  if (const JsonValue* graphs = changed.find("graphs"); graphs && !made.empty()) {
    const JsonValue graph = *graphs->find(made);
    JsonValue& all = *context.document.find("graphs");
    const auto at = std::ranges::find(all.members, context.level, &JsonMember::name);
    all.members.insert(at, {made, {}, graph});
  }
  std::erase_if(changed.members, [](const JsonMember& m) { return m.name == "graphs"; });
  context.graph() = std::move(changed);
}

}  // namespace

void group(EditContext& context) {
  const std::string& name = context.text("name");
  const std::vector<std::string> nodes = context.texts("nodes");
  if (find_graph(context.document, name))
    throw Error(pointer_of({"graphs", name}),
                fmt::format("there is a graph or node type {} already; choose another name", in_quotes(name)));
  for (const std::string& node : nodes) context.node(node);
  const LevelTypes types(context);
  JsonValue changed = as_document(context);
  detail::group(changed, types.graph(), name, nodes);
  put_back(context, std::move(changed), name);
  context.out.added.push_back(name);
  context.label(fmt::format("group {} nodes as {}", nodes.size(), in_quotes(name)));
}

void ungroup(EditContext& context) {
  const std::string& name = context.text("node");
  const JsonValue* type = context.node(name).find("type");
  LevelTypes types(context);
  const Subgraph* graph = type ? types.graphs().find(*type, types.graph()) : nullptr;
  if (!graph || !graph->json->find("nodes"))
    throw Error(context.pointer({"nodes", name}), fmt::format("the node {} is of type {}, which is not a graph",
                                                              in_quotes(name), in_quotes(type ? type->text : "")));
  if (graph->folder != types.main().folder)
    throw Error(context.pointer({"nodes", name}),
                fmt::format("{} is in another folder, and its paths are relative to that", in_quotes(type->text)));
  const std::string title = type->text;
  std::set<std::string> before;
  for (const JsonMember& m : context.section("nodes").members) before.insert(m.name);
  before.erase(name);
  JsonValue changed = as_document(context);
  detail::ungroup(changed, *graph, name);
  put_back(context, std::move(changed), "");
  for (const JsonMember& m : context.section("nodes").members)
    if (!before.contains(m.name)) context.out.added.push_back(m.name);
  // In a document's own nodes the function has removed a graph that nothing uses any more.
  JsonValue* graphs = context.document.find("graphs");
  if (!context.level.empty() && graphs && graphs->find(title)) {
    bool is_used = uses_type(context.document, title);
    for (const JsonMember& m : graphs->members) is_used |= uses_type(m.value, title);
    if (!is_used) std::erase_if(graphs->members, [&](const JsonMember& m) { return m.name == title; });
  }
  context.label("ungroup " + in_quotes(name));
}

void paste(EditContext& context) {
  Clip clip = read_clip(context.text("text"));
  if (!context.level.empty() && (clip.graphs.find(context.level) || uses_type(JsonValue(clip.nodes), context.level)))
    throw Error(fmt::format("the graph {} cannot be part of itself", in_quotes(context.level)));
  add_clip_graphs(context, clip);
  std::map<std::string, std::string> names;
  std::set<std::string> taken;
  for (const JsonMember& m : clip.nodes.members) {
    std::string name = context.free_name(m.name);
    for (int i = 2; taken.contains(name); i++) name = context.free_name(fmt::format("{}_{}", m.name, i));
    taken.insert(name);
    names[m.name] = name;
  }
  const JsonValue* inputs = context.graph().find("inputs");
  const auto is_unknown = [&](const std::string& node) {
    return !names.contains(node) && !context.find_node(node) && !(inputs && inputs->find(node));
  };
  JsonValue& nodes = context.section("nodes");
  std::vector<JsonMember> pasted;
  for (const JsonMember& m : clip.nodes.members) {
    JsonMember node{names.at(m.name), {}, m.value};
    for (const std::string& port : without_wires(node.value, is_unknown))
      context.out.taken.push_back(fmt::format("a wire into the port {} of {}", in_quotes(port), in_quotes(node.name)));
    rename_nodes(node.value, names);
    pasted.push_back(std::move(node));
  }
  for (JsonMember& m : pasted) {
    context.out.added.push_back(m.name);
    nodes.members.push_back(std::move(m));
  }
  context.label(pasted.size() == 1 ? "paste " + in_quotes(context.out.added.back())
                                   : fmt::format("paste {} nodes", pasted.size()));
}

}  // namespace terrazzo::edits

namespace terrazzo {

std::string copied_nodes(std::string_view text, const std::string& level, const std::vector<std::string>& nodes) {
  edits::EditContext context{.document = json_in(text), .file = {}, .level = level};
  edits::Clip clip;
  for (const std::string& name : nodes) context.node(name);
  if (const JsonValue* all = context.graph().find("nodes"))
    for (const JsonMember& m : all->members)
      if (std::ranges::find(nodes, m.name) != nodes.end()) clip.nodes.members.push_back(m);
  if (!clip.nodes.members.empty()) {
    std::vector<std::string>& above = clip.nodes.members.front().value.comments_before;
    while (!above.empty() && above.front().empty()) above.erase(above.begin());
  }
  edits::add_graphs(context.document, clip.nodes, clip.graphs);
  JsonValue out = JsonValue::empty_object();
  out.set("nodes", std::move(clip.nodes));
  if (!clip.graphs.members.empty()) out.set("graphs", std::move(clip.graphs));
  return formatted(out);
}

}  // namespace terrazzo
