#include "graphs/document/nodes.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/base/hash.h"
#include "core/base/suggest.h"
#include "core/file/read_guard.h"
#include "graphs/values/convert.h"

namespace terrazzo {

namespace {

/// Independent of other nodes and their order. 31 bits, which every tool can represent.
int64_t derived_seed(int64_t graph_seed, const std::string& node) {
  const std::string hex = Hasher().add("seed of a node").add(graph_seed).add(node).digest().hex();
  return int64_t(std::stoul(hex.substr(0, 8), nullptr, 16) & 0x7FFFFFFF);
}

class NodeReader {
 public:
  NodeReader(NodeDraft& draft, std::vector<Problem>& problems)
      : draft_(draft),
        reading_(*draft.reading),
        substitution_(*draft.substitution),
        problems_(problems),
        where_("node " + in_quotes(draft.node.name)) {}

  void read(const JsonValue& value, const std::vector<const Override*>& overrides) {
    if (!value.is_object()) {
      report(value.place, "expected an object such as {\"type\": \"load_map\", ...}, found " + found(value));
    } else if (draft_.node.type || find_type(value)) {
      if (const JsonValue* mute = value.find("mute")) read_mute(*mute);
      for (const Override* o : overrides)
        if (o->name == "mute") read_mute(o->json_for({.name = "mute", .type = ParamType::boolean}));
      if (const JsonValue* comment = value.find("comment")) read_comment(*comment);
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
  void report(Place place, const std::string& message, const std::string& parameter = "") {
    Diagnostics(problems_, where_, parameter).add(place, message);
  }

  bool find_type(const JsonValue& value) {
    const JsonValue* given = value.find("type");
    if (!given) {
      report(draft_.node.place, "expected a \"type\"; `terrazzo nodes` lists them");
      return false;
    }
    if (!given->is_text()) {
      report(given->place, "expected the name of a node type, found " + found(*given));
      return false;
    }
    draft_.node.type = reading_.known->find(given->text);
    if (!draft_.node.type) {
      std::vector<std::string> names;
      if (problems_.size() < most_problems_shown) {
        names = *reading_.graph_names;
        names.insert(names.end(), reading_.known->names.begin(), reading_.known->names.end());
      }
      report(given->place, fmt::format("unknown node type {}{}; `terrazzo nodes` lists all", in_quotes(given->text),
                                       did_you_mean(given->text, names)));
    }
    return draft_.node.type;
  }

  void read_mute(const JsonValue& mute) {
    const Param param{.name = "mute", .type = ParamType::boolean};
    Diagnostics diagnostics(problems_, where_ + ", \"mute\"");
    const std::optional<JsonValue> value = substitution_.expand(mute, param, diagnostics);
    const Lacking lacking = substitution_.take_lacking();
    draft_.unset.insert(lacking.unset.begin(), lacking.unset.end());
    if (!lacking.nodes.empty())
      diagnostics.add(mute.place, "whether a node is muted cannot depend on the results of nodes");
    if (!value) return;
    if (const auto read = read_param(*value, param, reading_.graph_folder, diagnostics))
      draft_.muted = std::get<bool>(*read);
  }

  void read_comment(const JsonValue& comment) {
    if (comment.is_text())
      draft_.node.comment = comment.text;
    else
      report(comment.place, "expected a text for \"comment\", found " + found(comment));
  }

  /// Applies "weights.height=2" to the whole map. False if `weights` is no map.
  bool add_member(const Override& o, std::vector<NodeEntry>& entries) {
    const size_t dot = o.name.find('.');
    const Param* param = dot == o.name.npos ? nullptr : type().find_param(o.name.substr(0, dot));
    if (!param || (param->type != ParamType::number_map && param->type != ParamType::text_map)) return false;
    const auto at = std::ranges::find(entries, param->name, &NodeEntry::name);
    JsonValue map = JsonValue::empty_object();
    if (at != entries.end() && at->merged)
      map = std::move(*at->merged);
    else if (at != entries.end())
      map = given_by(*at, *param);
    else if (param->fallback)
      map = json_of(*param->fallback);
    std::optional<JsonValue> merged = with_member(std::move(map), o.name.substr(dot + 1), o, problems_);
    if (!merged) return true;
    const NodeEntry entry{param->name, o.place, nullptr, &o, std::make_shared<JsonValue>(std::move(*merged))};
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
      if (std::ranges::find(common_node_keys(), m.name) == common_node_keys().end())
        out.push_back({m.name, m.place, &m.value, nullptr});
    for (const Override* o : overrides) {
      const bool is_common = o->name == "mute" || (o->name == "foreach" && o->json);
      if (is_common || add_member(*o, out)) continue;
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
                : Diagnostics(problems_, fmt::format("{}, {} {}", where_, kind, in_quotes(e.name)), e.name);
  }

  void read_entry(const NodeEntry& e) {
    given_.insert(e.name);
    draft_.node.places[e.name] = e.place;
    if (e.value) note_parts(e.name, *e.value);
    if (const Port* port = type().find_input(e.name)) {
      read_port(e, *port);
    } else if (const Param* param = type().find_param(e.name)) {
      read_parameter(e, *param);
    } else {
      std::vector<std::string> names;
      for (const Port& p : type().inputs) names.push_back(p.name);
      for (const Param& p : type().params) names.push_back(p.name);
      Diagnostics diagnostics = e.by ? e.by->diagnostics(problems_) : Diagnostics(problems_, where_);
      std::string hint = did_you_mean(e.name, names);
      if (hint.empty()) hint = did_you_mean(e.name, common_node_keys());
      if (hint.empty()) hint = suggestion(e.name, names);
      diagnostics.add(e.place, fmt::format("{} has no port or parameter {}{}", type().name, in_quotes(e.name), hint));
    }
  }

  void note_parts(const std::string& name, const JsonValue& value) {
    std::map<std::string, Place>& places = draft_.node.places;
    for (const JsonMember& m : value.members) places[name + "." + m.name] = m.place;
    for (size_t i = 0; i < value.items.size(); i++) places[fmt::format("{}.{}", name, i)] = value.items[i].place;
  }

  void read_parameter(const NodeEntry& e, const Param& param) {
    const size_t before = problems_.size();
    read_value(e, param);
    set_code(problems_, before, e.by ? "override" : "parameter");
  }

  void read_value(const NodeEntry& e, const Param& param) {
    Diagnostics diagnostics = complaints_about(e, "parameter");
    const JsonValue given = given_by(e, param);
    const std::optional<JsonValue> value = substitution_.expand(given, param, diagnostics);
    const Lacking lacking = substitution_.take_lacking();
    draft_.unset.insert(lacking.unset.begin(), lacking.unset.end());
    draft_.asked.insert(lacking.nodes.begin(), lacking.nodes.end());
    if (!lacking.nodes.empty()) draft_.waiting.push_back(e);
    if (!value) return;
    if (std::set<std::string> names = parameters_in(given); !names.empty() || param.type == ParamType::path)
      draft_.names_by[param.name] = std::move(names);
    const std::filesystem::path& base = e.by ? e.by->base : reading_.graph_folder;
    if (std::optional<ParamValue> read = read_param(*value, param, base, diagnostics)) {
      const bool is_literal = value->is_text() && given.is_text() && value->text == given.text;
      if (e.by && e.by->allows_reading && param.type == ParamType::path && is_literal)
        ReadGuard::allow(std::get<std::string>(*read));
      draft_.node.params.emplace(param.name, std::move(*read));
    }
  }

  void read_port(const NodeEntry& e, const Port& port) {
    const size_t before = problems_.size();
    PortWires wires{&port, {}, complaints_about(e, "port")};
    const JsonValue given = e.by ? e.by->json_for({.name = port.name, .type = ParamType::texts}) : *e.value;
    const auto expanded = expand_wires(given, substitution_, wires.diagnostics, draft_.named, draft_.unset);
    // An expression may leave the port open.
    if (port.optional && expanded && expanded->is_text() && expanded->text.empty() && !given.text.empty()) return;
    if (expanded) read_wires(wires, *expanded);
    set_code(problems_, before, "wire");
    draft_.ports.push_back(std::move(wires));
  }

  static void read_wires(PortWires& into, const JsonValue& given) {
    const Port& port = *into.port;
    const std::string expected = fmt::format("a {} such as \"@node\" or \"@node.port\"{}",
                                             port.list ? "list of wires" : "wire", port.list ? ", or one wire," : "");
    if (is_wire(given)) {
      into.wires.push_back(wire_end(given, into.diagnostics));
    } else if (!given.is_list() || !port.list) {
      into.diagnostics.add(given.place,
                           fmt::format("expected {} found {}", port.list ? expected : expected + ",", found(given)));
    } else if (given.items.empty() && !port.optional) {
      into.diagnostics.add(given.place, "expected at least one wire such as \"@node\", found an empty list");
    } else {
      for (const JsonValue& item : given.items) {
        if (is_wire(item)) {
          into.wires.push_back(wire_end(item, into.diagnostics));
        } else {
          into.diagnostics.add(item.place, "expected a wire such as \"@node\" or \"@node.port\", found " + found(item));
        }
      }
    }
  }

  void add_missing() {
    for (const Port& p : type().inputs)
      if (!p.optional && !given_.contains(p.name))
        report(draft_.node.place,
               fmt::format("the port \"{}\" must be given: expected a wire of type {}", p.name, name_of(p.type)),
               p.name);
    for (const Param& p : type().params) {
      if (given_.contains(p.name)) continue;
      if (p.name == "seed" && p.type == ParamType::integer && reading_.seed) {
        draft_.node.params.emplace(p.name, derived_seed(*reading_.seed, reading_.seed_path + draft_.local));
      } else if (p.fallback) {
        draft_.node.params.emplace(p.name, default_of(p, reading_.graph_folder));
      } else {
        report(draft_.node.place,
               fmt::format("the parameter \"{}\" must be given: expected {}", p.name, expectation(p)), p.name);
      }
    }
  }

  void run_check() {
    if (draft_.node.params.size() < type().params.size()) return;
    const bool is_foreign = !type().origin.name.empty();
    try {
      if (type().check)
        for (const std::string& message : type().check(draft_.node.params)) {
          const std::string about = subject_of(message);
          report(draft_.node.place_of(about), message, about);
        }
      // Many callers use files_read and do not expect it to throw.
      if (is_foreign && type().files_read) type().files_read(draft_.node.params);
    } catch (const Error& e) {
      report(draft_.node.place_of(e.about()), e.what(), e.about());
    }
  }

  /// The quoted parameter at the beginning of a message; empty if there is none.
  static std::string subject_of(const std::string& message) {
    const size_t end = message.find('"', 1);
    return message.starts_with('"') && end != message.npos ? message.substr(1, end - 1) : "";
  }

  NodeDraft& draft_;
  const NodeReading& reading_;
  Substitution& substitution_;
  std::vector<Problem>& problems_;
  std::string where_;
  std::set<std::string> given_;
};

}  // namespace

KnownTypes::KnownTypes(const std::vector<NodeType>& known) {
  for (const NodeType& t : known) {
    types.emplace(t.name, &t);
    names.push_back(t.name);
  }
}

const NodeType* KnownTypes::find(std::string_view name) const {
  const auto at = types.find(name);
  return at == types.end() ? nullptr : at->second;
}

const std::vector<std::string>& common_node_keys() {
  static const std::vector<std::string> keys = {"comment", "foreach", "mute", "type"};
  return keys;
}

bool is_wire(const JsonValue& v) {
  return v.is_text() && v.text.starts_with("@") && !v.text.starts_with("@@");
}

std::pair<std::string, std::string> wire_parts(const std::string& text) {
  const size_t dot = std::min(text.find('.'), text.size());
  return {text.substr(1, dot - 1), text.substr(std::min(dot + 1, text.size()))};
}

WireEnd wire_end(const JsonValue& text, Diagnostics& diagnostics) {
  if (text.text.ends_with('.'))
    diagnostics.add(text.place, "expected an output's name after the dot in " + in_quotes(text.text));
  auto [node, port] = wire_parts(text.text);
  return {std::move(node), std::move(port), text.place, text.text};
}

std::optional<JsonValue> expand_wires(const JsonValue& given, Substitution& substitution, Diagnostics& diagnostics,
                                      std::set<std::string>& named, std::set<std::string>& unset) {
  if (given.is_list()) {
    JsonValue out = given;
    for (JsonValue& item : out.items) {
      std::optional<JsonValue> expanded = expand_wires(item, substitution, diagnostics, named, unset);
      if (!expanded) return std::nullopt;
      item = std::move(*expanded);
    }
    return out;
  }
  if (!given.is_text() || !is_expression(given.text)) return given;
  for (size_t at = given.text.find("'@"); at != std::string::npos; at = given.text.find("'@", at + 1)) {
    const size_t end = std::min(given.text.find_first_of(".'", at + 2), given.text.size());
    named.insert(given.text.substr(at + 2, end - at - 2));
  }
  std::optional<JsonValue> out = substitution.expand(given, {.name = "", .type = ParamType::texts}, diagnostics);
  const Lacking lacking = substitution.take_lacking();
  unset.insert(lacking.unset.begin(), lacking.unset.end());
  if (!lacking.nodes.empty()) diagnostics.add(given.place, "a wire cannot depend on the results of nodes");
  return out;
}

void read_node(NodeDraft& draft, const JsonValue& value, const std::vector<const Override*>& overrides,
               std::vector<Problem>& problems) {
  const size_t before = problems.size();
  NodeReader(draft, problems).read(value, overrides);
  set_node(problems, before, draft.node.name);
}

void read_waiting(NodeDraft& draft, std::vector<Problem>& problems) {
  const size_t before = problems.size();
  NodeReader(draft, problems).read_waiting();
  set_node(problems, before, draft.node.name);
}

}  // namespace terrazzo
