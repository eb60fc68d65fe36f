#include "graphs/document/nodes.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/base/hash.h"
#include "core/base/suggest.h"
#include "graphs/document/convert.h"

namespace terrazzo {

namespace {

bool is_wire(const JsonValue& v) {
  return v.is_text() && v.text.starts_with("@") && !v.text.starts_with("@@");
}

/// The order of nodes does not matter, nor do other nodes. 31 bits: every tool that shows it can hold it.
int64_t derived_seed(int64_t graph_seed, const std::string& node) {
  const std::string hex = Hasher().add("seed of a node").add(graph_seed).add(node).digest().hex();
  return int64_t(std::stoul(hex.substr(0, 8), nullptr, 16) & 0x7FFFFFFF);
}

class NodeReader {
 public:
  NodeReader(NodeDraft& draft, const NodeReading& reading, Substitution& substitution, std::vector<Problem>& problems)
      : draft_(draft),
        reading_(reading),
        substitution_(substitution),
        problems_(problems),
        where_("node " + in_quotes(draft.node.name)) {}

  void read(const JsonValue& value, const std::vector<const Override*>& overrides) {
    const Place place = draft_.node.place;
    if (!is_node_name(draft_.node.name)) complain(place, "expected a name of letters, digits, _ and -");
    if (!value.is_object()) {
      complain(value.place, "expected an object such as {\"type\": \"load_map\", ...}, found " + found(value));
    } else if (find_type(value)) {
      for (const NodeEntry& e : entries(value, overrides)) read_entry(e);
      add_missing();
      run_check();
    }
  }

  void read_waiting() {
    const std::vector<NodeEntry> waiting = std::exchange(draft_.waiting, {});
    for (const NodeEntry& e : waiting) read_parameter(e, *type().find_param(e.name));
    run_check();
  }

 private:
  const NodeType& type() const { return *draft_.node.type; }
  void complain(Place place, const std::string& message) { problems_.push_back({place, where_, message}); }

  bool find_type(const JsonValue& value) {
    const JsonValue* given = value.find("type");
    if (!given) {
      complain(draft_.node.place, "expected a \"type\"; `terrazzo nodes` lists them");
      return false;
    }
    const auto at = given->is_text() ? reading_.types.find(given->text) : reading_.types.end();
    if (at != reading_.types.end()) {
      draft_.node.type = at->second;
      return true;
    }
    if (!given->is_text()) {
      complain(given->place, "expected the name of a node type, found " + found(*given));
    } else {
      complain(given->place, fmt::format("unknown node type {}{}; `terrazzo nodes` lists all", in_quotes(given->text),
                                         did_you_mean(given->text, reading_.type_names)));
    }
    return false;
  }

  /// Of "weights.height=2" the whole map, if `weights` is one. False if it is not.
  bool add_member(const Override& o, std::vector<NodeEntry>& entries) {
    const size_t dot = o.name.find('.');
    const Param* param = dot == o.name.npos ? nullptr : type().find_param(o.name.substr(0, dot));
    if (!param || (param->type != ParamType::number_map && param->type != ParamType::text_map)) return false;
    const auto at = std::ranges::find(entries, param->name, &NodeEntry::name);
    JsonValue map;
    map.kind = JsonValue::Kind::object;
    if (at != entries.end())
      map = given_by(*at, *param);
    else if (param->fallback)
      map = json_of(*param->fallback);
    const std::optional<JsonValue> merged = with_member(std::move(map), o.name.substr(dot + 1), o, problems_);
    if (!merged) return true;
    const NodeEntry entry{param->name, o.place, nullptr, &o, std::make_shared<const JsonValue>(*merged)};
    if (at == entries.end()) {
      entries.push_back(entry);
    } else {
      *at = entry;
    }
    return true;
  }

  static JsonValue given_by(const NodeEntry& e, const Param& param) {
    return e.merged ? *e.merged : e.by ? e.by->json_for(param) : *e.value;
  }

  std::vector<NodeEntry> entries(const JsonValue& value, const std::vector<const Override*>& overrides) {
    std::vector<NodeEntry> out;
    for (const JsonMember& m : value.members)
      if (m.name != "type") out.push_back({m.name, m.place, &m.value, nullptr});
    for (const Override* o : overrides) {
      if (add_member(*o, out)) continue;
      const auto at = std::find_if(out.begin(), out.end(), [&](const NodeEntry& e) { return e.name == o->name; });
      if (at == out.end()) {
        out.push_back({o->name, o->place, nullptr, o});
      } else {
        *at = {o->name, o->place, nullptr, o};
      }
    }
    return out;
  }

  Diagnostics complaints_about(const NodeEntry& e, std::string_view kind) {
    return e.by ? e.by->diagnostics(problems_)
                : Diagnostics(problems_, fmt::format("{}, {} {}", where_, kind, in_quotes(e.name)));
  }

  void read_entry(const NodeEntry& e) {
    given_.insert(e.name);
    draft_.node.places[e.name] = e.place;
    if (const Port* port = type().find_input(e.name)) {
      read_port(e, *port);
    } else if (const Param* param = type().find_param(e.name)) {
      read_parameter(e, *param);
    } else {
      std::vector<std::string> names;
      for (const Port& p : type().inputs) names.push_back(p.name);
      for (const Param& p : type().params) names.push_back(p.name);
      Diagnostics diagnostics = e.by ? e.by->diagnostics(problems_) : Diagnostics(problems_, where_);
      diagnostics.add(e.place, fmt::format("{} has no port or parameter {}{}", type().name, in_quotes(e.name),
                                           suggestion(e.name, names)));
    }
  }

  void read_parameter(const NodeEntry& e, const Param& param) {
    Diagnostics diagnostics = complaints_about(e, "parameter");
    const JsonValue given = given_by(e, param);
    const std::optional<JsonValue> value = substitution_.expand(given, param, diagnostics);
    const Lacking lacking = substitution_.take_lacking();
    draft_.unset.insert(lacking.unset.begin(), lacking.unset.end());
    draft_.asked.insert(lacking.nodes.begin(), lacking.nodes.end());
    if (!lacking.nodes.empty()) draft_.waiting.push_back(e);
    if (!value) return;
    if (param.type == ParamType::path) draft_.node.files_by[param.name] = substitution_.paths_in(given);
    const std::filesystem::path& base = e.by ? e.by->base : reading_.graph_folder;
    if (std::optional<ParamValue> read = read_param(*value, param, base, diagnostics))
      draft_.node.params.emplace(param.name, std::move(*read));
  }

  void read_port(const NodeEntry& e, const Port& port) {
    PortWires wires{&port, {}, complaints_about(e, "port")};
    const JsonValue given = e.by ? e.by->json_for({.name = port.name, .type = ParamType::texts}) : *e.value;
    const std::string expected = fmt::format("a {} such as \"@node\" or \"@node.port\"{}",
                                             port.list ? "list of wires" : "wire", port.list ? ", or one wire," : "");
    if (is_wire(given)) {
      add_wire(wires, given);
    } else if (!given.is_list() || !port.list) {
      wires.diagnostics.add(given.place,
                            fmt::format("expected {} found {}", port.list ? expected : expected + ",", found(given)));
    } else if (given.items.empty() && !port.optional) {
      wires.diagnostics.add(given.place, "expected at least one wire such as \"@node\", found an empty list");
    } else {
      for (const JsonValue& item : given.items) {
        if (is_wire(item)) {
          add_wire(wires, item);
        } else {
          wires.diagnostics.add(item.place,
                                "expected a wire such as \"@node\" or \"@node.port\", found " + found(item));
        }
      }
    }
    draft_.ports.push_back(std::move(wires));
  }

  static void add_wire(PortWires& wires, const JsonValue& text) {
    const std::string end = text.text.substr(1);
    const size_t dot = end.find('.');
    wires.wires.push_back({end.substr(0, dot), dot == end.npos ? "" : end.substr(dot + 1), text.place, text.text});
    if (dot + 1 == end.size())
      wires.diagnostics.add(text.place, "expected an output's name after the dot in " + in_quotes(text.text));
  }

  void add_missing() {
    for (const Port& p : type().inputs)
      if (!p.optional && !given_.contains(p.name))
        complain(draft_.node.place,
                 fmt::format("the port \"{}\" must be given: expected a wire of type {}", p.name, name_of(p.type)));
    for (const Param& p : type().params) {
      if (given_.contains(p.name)) continue;
      if (p.name == "seed" && p.type == ParamType::integer && reading_.seed) {
        draft_.node.params.emplace(p.name, derived_seed(*reading_.seed, draft_.node.name));
      } else if (p.fallback) {
        draft_.node.params.emplace(p.name, default_of(p, reading_.graph_folder));
      } else {
        complain(draft_.node.place,
                 fmt::format("the parameter \"{}\" must be given: expected {}", p.name, expectation(p)));
      }
    }
  }

  void run_check() {
    if (!type().check || draft_.node.params.size() < type().params.size()) return;
    for (const std::string& message : type().check(draft_.node.params)) complain(place_of(message), message);
  }

  /// Where the parameter stands that a message begins with, in quotes; else the node.
  Place place_of(const std::string& message) const {
    const size_t end = message.find('"', 1);
    return draft_.node.place_of(message.starts_with('"') && end != message.npos ? message.substr(1, end - 1) : "");
  }

  NodeDraft& draft_;
  const NodeReading& reading_;
  Substitution& substitution_;
  std::vector<Problem>& problems_;
  std::string where_;
  std::set<std::string> given_;
};

}  // namespace

NodeReading::NodeReading(const std::vector<NodeType>& known) {
  for (const NodeType& t : known) {
    types.emplace(t.name, &t);
    type_names.push_back(t.name);
  }
}

std::vector<NodeDraft> read_nodes(const JsonValue& section, const std::vector<Override>& overrides,
                                  const NodeReading& reading, Substitution& substitution,
                                  std::vector<Problem>& problems) {
  std::map<std::string, std::vector<const Override*>> by_node;
  std::vector<std::string> names;
  for (const JsonMember& m : section.members) names.push_back(m.name);
  for (const Override& o : overrides) {
    if (o.node.empty()) continue;
    by_node[o.node].push_back(&o);
    if (std::find(names.begin(), names.end(), o.node) == names.end())
      o.diagnostics(problems).add(
          o.place, fmt::format("the graph has no node {}{}", in_quotes(o.node), suggestion(o.node, names)));
  }
  std::vector<NodeDraft> drafts;
  for (const JsonMember& m : section.members) {
    const auto its = by_node.find(m.name);
    const size_t before = problems.size();
    NodeDraft& draft = drafts.emplace_back();
    draft.node.name = m.name;
    draft.node.place = m.place;
    NodeReader(draft, reading, substitution, problems)
        .read(m.value, its == by_node.end() ? std::vector<const Override*>() : its->second);
    for (size_t i = before; i < problems.size(); i++) problems[i].node = m.name;
  }
  return drafts;
}

void read_waiting(NodeDraft& draft, const NodeReading& reading, Substitution& substitution,
                  std::vector<Problem>& problems) {
  const size_t before = problems.size();
  NodeReader(draft, reading, substitution, problems).read_waiting();
  for (size_t i = before; i < problems.size(); i++) problems[i].node = draft.node.name;
}

}  // namespace terrazzo
