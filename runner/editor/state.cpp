#include "runner/editor/state.h"

#include <algorithm>
#include <set>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "graphs/document/load.h"
#include "graphs/document/subgraphs.h"
#include "graphs/text/edit.h"
#include "graphs/tools/descriptor_json.h"
#include "graphs/values/convert.h"
#include "runner/editor/hidden_parameters.h"
#include "runner/editor/state_problems.h"
#include "runner/editor/types_json.h"

namespace terrazzo {

using nlohmann::ordered_json;

namespace {

ordered_json port_as_json(const Port& p) {
  return {{"name", p.name}, {"type", name_of(p.type)}, {"required", !p.optional}, {"list", p.list}, {"help", p.help}};
}

/// By target, "seed" or "node.parameter".
ordered_json values_of(const Preset& preset) {
  ordered_json out = ordered_json::object();
  for (const Override& o : preset.set)
    out[o.node.empty() ? o.name : o.node + "." + o.name] = o.json ? json_of_value(*o.json) : ordered_json(o.value);
  return out;
}

bool is_changing_text(const JsonValue& v) {
  if (v.is_text()) return v.text.starts_with("=") || v.text.find('$') != v.text.npos;
  return std::ranges::any_of(v.items, is_changing_text) ||
         std::ranges::any_of(v.members, [](const JsonMember& m) { return is_changing_text(m.value); });
}

/// "walls/layout" for "walls[brick]/layout".
std::string without_labels(const std::string& path) {
  std::string out;
  for (size_t at = 0; at < path.size(); at++) {
    if (path[at] == '[')
      at = std::min(path.find(']', at), path.size() - 1);
    else
      out += path[at];
  }
  return out;
}

class StateWriter {
 public:
  StateWriter(const JsonValue& document, const DocumentSnapshot& snapshot, const InspectedGraph& inspected)
      : document_(document),
        inspected_(inspected),
        layout_(complete_layout(snapshot.text, snapshot.layout.levels)),
        main_(graphs_.read_main(document, snapshot.file)) {
    for (const auto& [node, values] : inspected.values) values_.emplace(without_labels(node), &values);
    std::vector<Problem> ignored;
    if (const JsonValue* section = document.find("presets")) presets_ = read_presets(*section, {}, "", true, ignored);
    for (const Preset& p : presets_) own_presets_.insert(p.name);
    for (Preset& p : presets_beside(snapshot.file, ignored)) presets_.push_back(std::move(p));
  }

  ordered_json levels() {
    ordered_json out = ordered_json::object();
    find_paths("", "");
    out[""] = level("", document_, main_);
    if (const JsonValue* graphs = document_.find("graphs"))
      for (const JsonMember& m : graphs->members)
        if (const Subgraph* graph = m.value.is_object() ? graphs_.find(JsonValue::of(m.name), main_) : nullptr)
          out[m.name] = level(m.name, m.value, *graph);
    return out;
  }

 private:
  /// The path of the first use of each graph of the document.
  void find_paths(const std::string& level, const std::string& path) {
    if (!paths_.emplace(level, path).second) return;
    const JsonValue* graphs = document_.find("graphs");
    const JsonValue* graph = level.empty() ? &document_ : graphs->find(level);
    const JsonValue* nodes = graph ? graph->find("nodes") : nullptr;
    if (!nodes || !graphs) return;
    for (const JsonMember& m : nodes->members)
      if (const JsonValue* type = m.value.find("type"); type && type->is_text() && graphs->find(type->text))
        find_paths(type->text, path + m.name + "/");
  }

  ordered_json level(const std::string& name, const JsonValue& json, const Subgraph& graph) {
    ordered_json out = {{"summary", graph.summary}, {"help", graph.help}};
    const std::vector<std::string> place =
        name.empty() ? std::vector<std::string>() : std::vector<std::string>{"graphs", name};
    ordered_json parameters = ordered_json::array();
    const std::set<std::string> hidden =
        name.empty() ? HiddenParameters(graphs_, values_).of_document(graph, inspected_.parameters)
                     : std::set<std::string>();
    for (const GraphParameter& p : graph.parameters) {
      ordered_json entry = parameter_as_json(p);
      std::vector<std::string> path = place;
      path.insert(path.end(), {"parameters", p.param.name});
      entry["pointer"] = pointer_of(path);
      if (name.empty())
        for (const GraphParameter& known : inspected_.parameters)
          if (known.param.name == p.param.name && known.value) entry["value"] = json_of_value(json_of(*known.value));
      if (hidden.contains(p.param.name)) entry["hidden"] = true;
      parameters.push_back(std::move(entry));
    }
    out["parameters"] = std::move(parameters);
    out["inputs"] = ordered_json::array();
    for (const Port& p : graph.inputs) out["inputs"].push_back(port_as_json(p));
    out["outputs"] = ordered_json::array();
    for (const GraphOutput& o : graph.outputs)
      out["outputs"].push_back(
          {{"name", o.port.name}, {"type", name_of(o.port.type)}, {"from", o.from.text}, {"help", o.port.help}});
    out["presets"] = ordered_json::array();
    if (name.empty())
      for (const Preset& p : presets_) {
        const bool is_here = own_presets_.contains(p.name);
        out["presets"].push_back(
            {{"name", p.name}, {"summary", p.help}, {"beside", !is_here}, {"values", values_of(p)}});
      }
    const LevelLayout& layout = layout_[name];
    ordered_json nodes = ordered_json::array();
    if (const JsonValue* all = json.find("nodes"))
      for (const JsonMember& m : all->members) nodes.push_back(node(name, place, m, graph, layout));
    out["nodes"] = std::move(nodes);
    out["frames"] = ordered_json::array();
    for (const auto& [id, f] : layout.frames)
      out["frames"].push_back(
          {{"id", id}, {"title", f.title}, {"x", f.x}, {"y", f.y}, {"width", f.width}, {"height", f.height}});
    out["bends"] = ordered_json::object();
    for (const auto& [wire, points] : layout.bends) out["bends"][wire] = points;
    out["boxes"] = ordered_json::object();  // of the inputs and the outputs, where they were moved
    for (const char* box : {"@inputs", "@outputs"})
      if (const auto at = layout.nodes.find(box); at != layout.nodes.end())
        out["boxes"][box] = {at->second.x, at->second.y};
    return out;
  }

  /// Ports and parameters. Those of the program's types are in types_json: repeated for each node they would be most of
  /// the state.
  static void write_interface(ordered_json& out, const Subgraph* inner) {
    ordered_json inputs = ordered_json::array(), outputs = ordered_json::array(), params = ordered_json::array();
    if (inner) {
      const NodeType type = type_of_use(*inner, {});
      for (const Port& p : type.inputs) inputs.push_back(port_as_json(p));
      for (const Port& p : type.outputs) outputs.push_back(port_as_json(p));
      for (const GraphParameter& p : inner->parameters) params.push_back(parameter_as_json(p));
    }
    out["inputs"] = std::move(inputs);
    out["outputs"] = std::move(outputs);
    out["params"] = std::move(params);
  }

  ordered_json node(const std::string& level, std::vector<std::string> path, const JsonMember& m, const Subgraph& graph,
                    const LevelLayout& layout) {
    path.insert(path.end(), {"nodes", m.name});
    const JsonValue* type = m.value.find("type");
    const NodeType* known = type && type->is_text() ? types_.find(type->text) : nullptr;
    const bool is_graph = !known && type && type->is_text();
    const Subgraph* inner = is_graph ? graphs_.find(*type, graph) : nullptr;
    ordered_json out = {{"name", m.name}, {"type", type ? type->text : ""}, {"known", known || inner}};
    out["category"] = known ? known->category : inner ? std::string(graph_category) : "";
    out["summary"] = known ? known->summary : inner ? inner->summary : "";
    if (const JsonValue* comment = m.value.find("comment")) out["comment"] = comment->text;
    const JsonValue* mute = m.value.find("mute");
    out["mute"] = mute ? json_of_value(*mute) : ordered_json(false);
    if (const JsonValue* loop = m.value.find("foreach")) out["foreach"] = json_of_value(*loop);
    const JsonValue* graphs = document_.find("graphs");
    if (inner && graphs && graphs->find(type->text)) out["level"] = type->text;
    write_values(out, level, path, m, graph);
    if (!known) write_interface(out, inner);
    if (inner)
      if (const auto use = paths_.find(level); use != paths_.end())
        if (const auto hidden = HiddenParameters(graphs_, values_).of_node(use->second + m.name, *inner);
            !hidden.empty())
          out["hidden"] = hidden;
    if (const auto at = layout.nodes.find(m.name); at != layout.nodes.end()) {
      out["x"] = at->second.x;
      out["y"] = at->second.y;
      out["pinned"] = at->second.pinned;
    }
    out["pointer"] = pointer_of(path);
    return out;
  }

  void write_values(ordered_json& out, const std::string& level, const std::vector<std::string>& path,
                    const JsonMember& m, const Subgraph& graph) {
    ordered_json values = ordered_json::object(), shown = ordered_json::object(), wires = ordered_json::array();
    const Params* read = nullptr;
    if (const auto at = paths_.find(level); at != paths_.end())
      if (const auto known = values_.find(at->second + m.name); known != values_.end()) read = known->second;
    for (const JsonMember& v : m.value.members) {
      if (v.name == "type" || v.name == "comment" || v.name == "mute" || v.name == "foreach") continue;
      std::vector<std::string> place = path;
      place.push_back(v.name);
      bool has_wires = is_wire(v.value);
      if (has_wires) wires.push_back(wire(v.value, v.name, 0, place, graph));
      for (size_t i = 0; i < v.value.items.size(); i++) {
        if (!is_wire(v.value.items[i])) continue;
        has_wires = true;
        std::vector<std::string> item = place;
        item.push_back(std::to_string(i));
        wires.push_back(wire(v.value.items[i], v.name, i, item, graph));
      }
      if (has_wires) continue;
      values[v.name] = json_of_value(v.value);
      if (read && is_changing_text(v.value))
        if (const auto at = read->find(v.name); at != read->end()) shown[v.name] = text_of(at->second);
    }
    out["values"] = std::move(values);
    out["shown"] = std::move(shown);
    out["wires"] = std::move(wires);
  }

  static ordered_json wire(const JsonValue& v, const std::string& port, size_t index,
                           const std::vector<std::string>& path, const Subgraph& graph) {
    auto [node, output] = wire_parts(v.text);
    const auto* source = graph.find_source(node);
    if (output.empty() && source && source->second && !source->second->outputs.empty())
      output = source->second->outputs.front().name;
    return {{"port", port}, {"index", index}, {"node", node}, {"output", output}, {"pointer", pointer_of(path)}};
  }

  const JsonValue& document_;
  const InspectedGraph& inspected_;
  std::map<std::string, LevelLayout> layout_;
  HiddenParameters::Values values_;
  std::map<std::string, std::string> paths_;  ///< by level
  std::vector<Preset> presets_;
  std::set<std::string> own_presets_;  ///< those in the document, rather than in the file beside it
  std::vector<Problem> ignored_;
  KnownTypes types_{node_types()};
  Subgraphs graphs_{types_, document_migrations(), ignored_};
  const Subgraph& main_;
};

const char* name_of(OnDisk state) {
  return state == OnDisk::same ? "same" : state == OnDisk::changed ? "changed" : "gone";
}

}  // namespace

ordered_json state_json(const DocumentSnapshot& d, const FoundProblems& found) {
  ordered_json out = {{"revision", d.revision},
                      {"file", {{"name", d.file.filename().string()}, {"folder", d.file.parent_path().string()}}},
                      {"saved", d.saved},
                      {"readOnly", d.read_only},
                      {"onDisk", name_of(d.on_disk)},
                      {"text", d.text}};
  if (!d.exists && d.on_disk == OnDisk::same && d.save_error.empty()) out["isNew"] = true;
  if (d.undo) out["undo"] = *d.undo;
  if (d.redo) out["redo"] = *d.redo;
  if (!d.save_error.empty()) out["saveError"] = d.save_error;
  if (!d.conflict.empty()) out["conflict"] = d.conflict;
  ParsedJson parsed = parse_json(d.text);
  StateProblems problems(d, parsed.value);
  if (!parsed.value || !parsed.value->is_object()) {
    const Problem broken = parsed.value ? Problem{parsed.value->place, "", "expected a graph, which begins with {"}
                                        : parsed.problems.back();
    out["broken"] = {{"line", broken.place.line}, {"column", broken.place.column}, {"message", broken.message}};
    out["levels"] = ordered_json::object();
    problems.add({broken}, "error");
  } else {
    const InspectedGraph inspected = inspect_graph_text(d.text, d.file, {.allow_unset = true});
    out["levels"] = StateWriter(*parsed.value, d, inspected).levels();
    problems.add(inspected.problems, "error");
    problems.add(inspected.warnings, "warning");
    problems.add(inspected.conversions, "note");
    problems.add(found.errors, "error");
    problems.add(found.warnings, "warning");
    problems.add(found.notes, "note");
  }
  if (!d.layout.fault.empty())
    problems.add({{{},
                   layout_path(d.file).filename().string(),
                   d.layout.fault + "; the nodes are laid out automatically, and moving one replaces the file"}},
                 "note");
  out["problems"] = problems.take();
  return out;
}

ordered_json preset_json(const DocumentSnapshot& d, const std::string& name) {
  std::vector<Problem> ignored;
  const JsonValue document = json_in(d.text);
  std::vector<Preset> presets;
  if (const JsonValue* section = document.find("presets")) presets = read_presets(*section, {}, "", true, ignored);
  for (Preset& p : presets_beside(d.file, ignored)) presets.push_back(std::move(p));
  const auto at = std::ranges::find(presets, name, &Preset::name);
  if (at == presets.end()) throw Error(fmt::format("the graph has no preset {}", in_quotes(name)));
  return {{"values", values_of(*at)}};
}

}  // namespace terrazzo
