#include <algorithm>
#include <map>
#include <set>

#include <fmt/format.h>

#include "core/base/suggest.h"
#include "graphs/tools/grouping.h"
#include "graphs/tools/rewrite.h"
#include "nodes/common/registry.h"

namespace terrazzo {

namespace {

/// The section with this name, created before `nodes` if missing.
JsonValue& section(JsonValue& document, const std::string& name) {
  if (JsonValue* known = document.find(name)) return *known;
  const auto nodes = std::ranges::find(document.members, "nodes", &JsonMember::name);
  return document.members.insert(nodes, {name, {}, JsonValue::empty_object()})->value;
}

class Grouping {
 public:
  Grouping(JsonValue& document, const Subgraph& main, const std::string& name, const std::vector<std::string>& nodes)
      : document_(document), main_(main), name_(name), moved_(nodes.begin(), nodes.end()) {}

  void run() {
    check();
    for (const JsonMember& m : document_.find("nodes")->members)
      if (moved_.contains(m.name)) taken_.insert(m.name);
    JsonValue inside = JsonValue::empty_object();
    for (const JsonMember& m : document_.find("nodes")->members)
      if (moved_.contains(m.name)) inside.members.push_back({m.name, m.place, rewritten_inside(m.value)});
    if (JsonValue* parameters = document_.find("parameters"))
      for (JsonMember& m : parameters->members) m.value = rewritten_outside(m.value);
    JsonValue* nodes = document_.find("nodes");
    for (JsonMember& m : nodes->members)
      if (!moved_.contains(m.name)) m.value = rewritten_outside(m.value);
    if (JsonValue* outputs = document_.find("outputs"))
      for (JsonMember& m : outputs->members) m.value = rewritten_outside(m.value);
    rename_in_presets();
    if (facts_.size() > 1)
      throw Error(
          fmt::format("expressions outside query {}, and can query only the first output of a subgraph; move fewer "
                      "nodes, or the querying nodes too",
                      listed({facts_.begin(), facts_.end()})));
    put_node(*nodes);
    section(document_, "graphs").set(name_, graph_with(std::move(inside)));
  }

 private:
  void check() const {
    std::vector<std::string> names;
    for (const JsonMember& m : document_.find("nodes")->members) names.push_back(m.name);
    for (const std::string& node : moved_)
      if (std::ranges::find(names, node) == names.end())
        throw Error(fmt::format("the graph has no node {}{}", in_quotes(node), suggestion(node, names)));
    if (!is_node_name(name_))
      throw Error(fmt::format("{}: expected a name of letters, digits, _ and -", in_quotes(name_)));
    const JsonValue* graphs = document_.find("graphs");
    if ((graphs && graphs->find(name_)) || find_node_type(name_))
      throw Error(fmt::format("there is a graph or node type {} already; choose another name", in_quotes(name_)));
    if (std::ranges::find(names, name_) != names.end() && !moved_.contains(name_))
      throw Error(fmt::format("there is a node {} already; choose another name", in_quotes(name_)));
  }

  JsonValue rewritten_inside(const JsonValue& node) {
    const TextChange change{
        .wire =
            [&](const std::string& from, const std::string& port, const JsonValue& text) {
              return moved_.contains(from) ? text : JsonValue::of("@" + input_for(from, port));
            },
        .fact = [&](const std::string& from) { return moved_.contains(from) ? from : input_for(from, ""); },
        .parameter =
            [&](const std::string& name) {
              // Other names are variables of the node's own loop.
              if (declaration(name)) used_.insert(name);
              return JsonValue::of("$" + name);
            }};
    return rewritten_entry(node, change);
  }

  JsonValue rewritten_outside(const JsonValue& value) {
    const TextChange change{
        .wire =
            [&](const std::string& from, const std::string& port, const JsonValue& text) {
              return moved_.contains(from) ? JsonValue::of(fmt::format("@{}.{}", name_, output_for(from, port))) : text;
            },
        .fact =
            [&](const std::string& from) {
              if (!moved_.contains(from)) return from;
              facts_.insert(from);
              output_for(from, "");
              return name_;
            },
        .parameter = [&](const std::string& name) { return JsonValue::of("$" + name); }};
    return rewritten_entry(value, change);
  }

  const JsonValue* declaration(const std::string& parameter) const {
    const JsonValue* parameters = document_.find("parameters");
    return parameters ? parameters->find(parameter) : nullptr;
  }

  std::string free_name(const std::string& wanted) {
    std::string out = wanted;
    std::ranges::replace(out, '-', '_');
    if (!is_parameter_name(out)) out = "from_" + out;
    const std::string plain = out;
    for (int i = 2; !taken_.insert(out).second; i++) out = fmt::format("{}_{}", plain, i);
    return out;
  }

  const Port& port_of(const std::string& node, const std::string& port) const {
    const auto* source = main_.find_source(node);
    const NodeType* type = source ? source->second : nullptr;
    const Port* out = !type || type->outputs.empty() ? nullptr
                      : port.empty()                 ? &type->outputs.front()
                                                     : type->find_output(port);
    if (!out) throw Error(fmt::format("the wire \"@{}{}{}\" leads nowhere", node, port.empty() ? "" : ".", port));
    return *out;
  }

  std::string input_for(const std::string& node, const std::string& port) {
    const Port& from = port_of(node, port);
    const auto [at, is_new] = inputs_.try_emplace({node, from.name});
    if (is_new) {
      at->second = free_name(declaration(node) ? node + "_in" : node);
      inputs_in_order_.push_back(at->first);
    }
    return at->second;
  }

  std::string output_for(const std::string& node, const std::string& port) {
    const Port& from = port_of(node, port);
    const auto [at, is_new] = outputs_.try_emplace({node, from.name});
    if (is_new) {
      at->second = free_output(node, from.name);
      outputs_in_order_.push_back(at->first);
    }
    return at->second;
  }

  std::string free_output(const std::string& node, const std::string& port) {
    for (const std::string& name : {port, node + "_" + port}) {
      std::string out = name;
      std::ranges::replace(out, '-', '_');
      if (is_parameter_name(out) && output_names_.insert(out).second) return out;
    }
    std::string out;
    for (int i = 2; !output_names_.insert(out = fmt::format("{}_{}", port, i)).second; i++) continue;
    return out;
  }

  static std::string wire(const std::string& node, const std::string& port, bool is_first) {
    return is_first ? "@" + node : fmt::format("@{}.{}", node, port);
  }

  bool is_first(const std::pair<std::string, std::string>& end) const {
    return port_of(end.first, "").name == end.second;
  }

  JsonValue graph_with(JsonValue nodes) {
    JsonValue out = JsonValue::empty_object();
    if (!inputs_.empty()) {
      JsonValue inputs = JsonValue::empty_object();
      for (const auto& end : inputs_in_order_) {
        JsonValue input = JsonValue::empty_object();
        input.set("type", JsonValue::of(std::string(name_of(port_of(end.first, end.second).type))));
        inputs.set(inputs_.at(end), std::move(input));
      }
      out.set("inputs", std::move(inputs));
    }
    if (JsonValue parameters = used_parameters(); !parameters.members.empty())
      out.set("parameters", std::move(parameters));
    out.set("nodes", std::move(nodes));
    if (!outputs_.empty()) {
      JsonValue outputs = JsonValue::empty_object();
      // Queried outputs come first, since expressions see only the first output.
      std::stable_partition(outputs_in_order_.begin(), outputs_in_order_.end(),
                            [&](const auto& end) { return facts_.contains(end.first); });
      for (const auto& end : outputs_in_order_)
        outputs.set(outputs_.at(end), JsonValue::of(wire(end.first, end.second, is_first(end))));
      out.set("outputs", std::move(outputs));
    }
    return out;
  }

  /// Declared as in the graph, without defaults that depend on other parameters of the graph.
  JsonValue used_parameters() const {
    JsonValue out = JsonValue::empty_object();
    const JsonValue* all = document_.find("parameters");
    if (!all) return out;
    for (const JsonMember& m : all->members) {
      if (!used_.contains(m.name)) continue;
      JsonMember copy = m;
      copy.value.comments_before.clear();
      std::erase_if(copy.value.members, [](const JsonMember& key) {
        const bool is_made = key.value.is_text() && is_expression(key.value.text);
        return key.name == "visible_if" || (key.name == "default" && is_made);
      });
      out.members.push_back(std::move(copy));
    }
    return out;
  }

  void put_node(JsonValue& nodes) {
    JsonValue node = JsonValue::empty_object();
    node.set("type", JsonValue::of(name_));
    for (const auto& end : inputs_in_order_)
      node.set(inputs_.at(end), JsonValue::of(wire(end.first, end.second, is_first(end))));
    if (const JsonValue* all = document_.find("parameters"))
      for (const JsonMember& m : all->members)
        if (used_.contains(m.name)) node.set(m.name, JsonValue::of("$" + m.name));
    const auto first =
        std::ranges::find_if(nodes.members, [&](const JsonMember& m) { return moved_.contains(m.name); });
    nodes.members.insert(first, {name_, {}, std::move(node)});
    // The new node may have the name of a node that it replaces.
    bool is_kept = false;
    std::erase_if(nodes.members, [&](const JsonMember& m) {
      const bool is_new = !is_kept && m.name == name_;
      is_kept |= is_new;
      return !is_new && moved_.contains(m.name);
    });
  }

  /// "layout.quality" as "name/layout.quality".
  void rename_in_presets() {
    JsonValue* presets = document_.find("presets");
    if (!presets) return;
    for (JsonMember& preset : presets->members)
      if (JsonValue* set = preset.value.find("set"))
        for (JsonMember& m : set->members)
          if (moved_.contains(m.name.substr(0, m.name.find_first_of("./[")))) m.name = name_ + "/" + m.name;
  }

  JsonValue& document_;
  const Subgraph& main_;
  const std::string& name_;
  const std::set<std::string> moved_;
  std::set<std::string> taken_, used_, facts_, output_names_;
  std::map<std::pair<std::string, std::string>, std::string> inputs_, outputs_;  ///< by node and port
  std::vector<std::pair<std::string, std::string>> inputs_in_order_, outputs_in_order_;
};

}  // namespace

void detail::group(JsonValue& document, const Subgraph& main, const std::string& name,
                   const std::vector<std::string>& nodes) {
  Grouping(document, main, name, nodes).run();
}

}  // namespace terrazzo
