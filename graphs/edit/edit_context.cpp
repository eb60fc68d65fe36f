#include "graphs/edit/edit_context.h"

#include <algorithm>
#include <set>

#include <fmt/format.h>

#include "core/base/suggest.h"
#include "graphs/document/nodes.h"
#include "graphs/text/edit.h"
#include "graphs/tools/rewrite.h"
#include "nodes/common/registry.h"

namespace terrazzo::edits {

const JsonValue& EditContext::value(std::string_view key) const {
  const JsonValue* v = change->find(key);
  if (!v) throw Error(fmt::format("the change {} needs \"{}\"", in_quotes(text_or_empty("op")), key));
  return *v;
}

const std::string& EditContext::text(std::string_view key) const {
  const JsonValue& v = value(key);
  if (!v.is_text()) throw Error(fmt::format("expected a text for \"{}\", found {}", key, found(v)));
  return v.text;
}

std::string EditContext::text_or_empty(std::string_view key) const {
  const JsonValue* v = change->find(key);
  return v && v->is_text() ? v->text : "";
}

std::vector<std::string> EditContext::texts(std::string_view key) const {
  const JsonValue& v = value(key);
  std::vector<std::string> out;
  for (const JsonValue& item : v.items) out.push_back(item.text);
  if (out.empty() || !std::ranges::all_of(v.items, &JsonValue::is_text))
    throw Error(fmt::format("expected a list of texts for \"{}\", found {}", key, found(v)));
  return out;
}

int64_t EditContext::position(std::string_view key) const {
  const JsonValue* v = change->find(key);
  return v && v->kind == JsonValue::Kind::integer ? v->integer : -1;
}

JsonValue& EditContext::graph() {
  if (level.empty()) return document;
  JsonValue* graphs = document.find("graphs");
  JsonValue* out = graphs ? graphs->find(level) : nullptr;
  if (!out || !out->is_object()) throw Error(fmt::format("the document has no graph {}", in_quotes(level)));
  return *out;
}

JsonValue& EditContext::section(const std::string& name) {
  JsonValue& in = graph();
  if (!in.find(name)) {
    // Before the nodes, as all else that they are made from.
    const auto nodes = std::ranges::find(in.members, "nodes", &JsonMember::name);
    const bool is_behind = name == "outputs" || name == "graphs";
    in.members.insert(is_behind ? in.members.end() : nodes, {name, {}, JsonValue::empty_object()});
  }
  JsonValue& out = *in.find(name);
  if (!out.is_object())
    throw Error(pointer({name}), fmt::format("{} is not an object of entries by name", in_quotes(name)));
  return out;
}

JsonValue* EditContext::find_node(const std::string& name) {
  JsonValue* nodes = graph().find("nodes");
  return nodes ? nodes->find(name) : nullptr;
}

JsonValue& EditContext::node(const std::string& name) {
  if (JsonValue* found_node = find_node(name)) return *found_node;
  std::vector<std::string> names;
  if (const JsonValue* nodes = graph().find("nodes"))
    for (const JsonMember& m : nodes->members) names.push_back(m.name);
  throw Error(fmt::format("the graph has no node {}{}", in_quotes(name), did_you_mean(name, names)));
}

std::string EditContext::pointer(std::vector<std::string> path) const {
  if (!level.empty()) path.insert(path.begin(), {"graphs", level});
  return pointer_of(path);
}

std::string EditContext::free_name(const std::string& wanted) {
  const auto is_taken = [&](const std::string& name) {
    const JsonValue* inputs = graph().find("inputs");
    return find_node(name) || (inputs && inputs->find(name));
  };
  std::string out = wanted;
  for (int i = 2; is_taken(out); i++) out = fmt::format("{}_{}", wanted, i);
  return out;
}

LevelTypes::LevelTypes(EditContext& context)
    : document_(context.document), known_(node_types()), graphs_(known_, document_migrations(), problems_) {
  if (!document_.is_object()) throw Error("the document is not a graph, which begins with {");
  main_ = graph_ = &graphs_.read_main(document_, context.file);
  if (context.level.empty()) return;
  graph_ = graphs_.find(JsonValue::of(context.level), *main_);
  if (!graph_) throw Error(fmt::format("the document has no graph {}", in_quotes(context.level)));
}

const NodeType* LevelTypes::of(const std::string& node) const {
  const auto* source = graph_->find_source(node);
  return source ? source->second : nullptr;
}

const NodeType* LevelTypes::named(const JsonValue& type) {
  if (const NodeType* known = type.is_text() ? known_.find(type.text) : nullptr) return known;
  const Subgraph* graph = graphs_.find(type, *graph_);
  return graph && !graph->is_wrong ? &uses_.emplace_back(type_of_use(*graph, {})) : nullptr;
}

namespace {

/// Changes each text of an entry by itself; what names none of the nodes concerned keeps its bytes.
void for_each_text(JsonValue& entry, const std::function<void(JsonValue& text)>& act, bool is_top = true) {
  if (entry.is_text()) return act(entry);
  for (JsonValue& item : entry.items) for_each_text(item, act, false);
  for (JsonMember& m : entry.members)
    if (!is_top || (m.name != "type" && m.name != "comment" && m.name != "help")) for_each_text(m.value, act, false);
}

/// The text with other names, and the names of nodes in it.
std::string renamed_text(const JsonValue& text, const std::map<std::string, std::string>& names,
                         std::set<std::string>& nodes) {
  const auto now = [&](const std::string& node) {
    nodes.insert(node);
    const auto at = names.find(node);
    return at == names.end() ? node : at->second;
  };
  try {
    return rewritten(text, renaming(now)).text;
  } catch (const Error&) {
    return text.text;  // a faulty expression
  }
}

}  // namespace

std::vector<std::string> named_nodes(const JsonValue& node) {
  std::set<std::string> nodes;
  JsonValue copy = node;
  for_each_text(copy, [&](JsonValue& text) { renamed_text(text, {}, nodes); });
  return {nodes.begin(), nodes.end()};
}

void rename_nodes(JsonValue& entry, const std::map<std::string, std::string>& names) {
  for_each_text(entry, [&](JsonValue& text) {
    if (text.text.find('@') == text.text.npos) return;
    std::set<std::string> nodes;
    std::string now = renamed_text(text, names, nodes);
    if (std::ranges::any_of(nodes, [&](const std::string& n) { return names.contains(n); })) text.text = std::move(now);
  });
}

std::vector<std::string> without_wires(JsonValue& entry, const std::function<bool(const std::string& node)>& is_gone) {
  std::vector<std::string> ports;
  const auto reads = [&](const JsonValue& v) {
    if (is_wire(v)) return is_gone(wire_parts(v.text).first);
    if (!v.is_text() || !v.text.starts_with("=")) return false;
    for (size_t at = v.text.find("'@"); at != v.text.npos; at = v.text.find("'@", at + 1)) {
      const size_t end = std::min(v.text.find_first_of(".'", at + 2), v.text.size());
      if (is_gone(v.text.substr(at + 2, end - at - 2))) return true;
    }
    return false;
  };
  std::erase_if(entry.members, [&](JsonMember& m) {
    if (m.name == "type" || m.name == "comment") return false;
    const size_t taken = std::erase_if(m.value.items, reads);
    const bool goes = reads(m.value) || (taken > 0 && m.value.items.empty());
    if (goes || taken > 0) ports.push_back(m.name);
    return goes;
  });
  return ports;
}

namespace {

/// Walks along one target, "parameter" or "node/node.parameter", and renames its parts. False where a part is gone.
bool walk_target(JsonValue& document, std::string& target, const TargetPart& on_node, const TargetPart& on_parameter) {
  const JsonValue* graphs = document.find("graphs");
  std::string out, level;
  size_t at = 0;
  for (bool is_path = target.find_first_of("./[") != target.npos; is_path;) {
    const JsonValue* graph = level.empty() ? &document : graphs ? graphs->find(level) : nullptr;
    const JsonValue* nodes = graph ? graph->find("nodes") : nullptr;
    const size_t end = std::min(target.find_first_of("./[", at), target.size());
    std::string node = target.substr(at, end - at);
    const JsonValue* use = nodes ? nodes->find(node) : nullptr;
    if (!use) return true;
    const JsonValue* type = use->find("type");
    if (on_node && !on_node(level, node)) return false;
    size_t next = end;
    if (next < target.size() && target[next] == '[') next = std::min(target.find(']', next) + 1, target.size());
    is_path = next < target.size() && target[next] == '/';
    if (next < target.size()) next++;  // the slash or dot
    out += node + target.substr(end, next - end);
    at = next;
    if (type && graphs && graphs->find(type->text)) {
      level = type->text;
      continue;
    }
    target = out + target.substr(at);
    return true;
  }
  const size_t end = std::min(target.find('.', at), target.size());
  std::string name = target.substr(at, end - at);
  if (on_parameter && !on_parameter(level, name)) return false;
  target = out + name + target.substr(end);
  return true;
}

}  // namespace

std::vector<std::string> walk_preset_targets(JsonValue& document, const TargetPart& on_node,
                                             const TargetPart& on_parameter) {
  std::vector<std::string> taken;
  JsonValue* presets = document.find("presets");
  if (!presets) return taken;
  for (JsonMember& preset : presets->members)
    if (JsonValue* set = preset.value.find("set"))
      std::erase_if(set->members, [&](JsonMember& m) {
        const bool goes = !walk_target(document, m.name, on_node, on_parameter);
        if (goes)
          taken.push_back(fmt::format("the preset {} no longer sets {}", in_quotes(preset.name), in_quotes(m.name)));
        return goes;
      });
  return taken;
}

}  // namespace terrazzo::edits

namespace terrazzo {

namespace {

using Act = void (*)(edits::EditContext&);

const std::map<std::string, Act, std::less<>>& acts() {
  static const std::map<std::string, Act, std::less<>> all = {{"add", edits::add},
                                                              {"remove", edits::remove},
                                                              {"connect", edits::connect},
                                                              {"disconnect", edits::disconnect},
                                                              {"set", edits::set},
                                                              {"unset", edits::unset},
                                                              {"parameter", edits::set_parameter},
                                                              {"preset", edits::set_preset},
                                                              {"value", edits::set_default},
                                                              {"input", edits::set_input},
                                                              {"output", edits::set_output},
                                                              {"rename", edits::rename},
                                                              {"group", edits::group},
                                                              {"ungroup", edits::ungroup},
                                                              {"paste", edits::paste},
                                                              {"insert", edits::insert}};
  return all;
}

}  // namespace

EditedText edited(std::string_view text, const std::filesystem::path& file, const JsonValue& changes) {
  edits::EditContext context{.document = json_in(text), .file = file};
  if (!context.document.is_object()) throw Error("the document is not a graph, which begins with {");
  for (const JsonValue& change : changes.items) {
    context.change = &change;
    context.level = context.text_or_empty("level");
    const std::string& op = context.text("op");
    const auto act = acts().find(op);
    if (act == acts().end()) {
      std::vector<std::string> names;
      for (const auto& [name, apply] : acts()) names.push_back(name);
      throw Error(fmt::format("there is no change {}{}", in_quotes(op), suggestion(op, names)));
    }
    act->second(context);
    context.out.added_by.resize(context.out.added.size(), size_t(&change - changes.items.data()));
  }
  if (changes.items.size() > 1 && !context.out.label.empty()) context.out.label += " and more";
  context.out.text = with_changes(text, context.document);
  return std::move(context.out);
}

}  // namespace terrazzo
