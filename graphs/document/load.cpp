#include "graphs/document/load.h"

#include <algorithm>
#include <map>
#include <set>

#include <fmt/format.h>

#include "core/base/suggest.h"
#include "graphs/document/convert.h"
#include "graphs/document/forecasts.h"
#include "graphs/document/nodes.h"
#include "graphs/document/read_document.h"
#include "graphs/document/wires.h"

namespace terrazzo {

namespace fs = std::filesystem;

namespace {

fs::path working_folder() {
  std::error_code failure;
  const fs::path folder = fs::current_path(failure);
  return failure ? fs::path("/") : folder;
}

/// A document on its way to a graph. All problems are collected; `finish` throws them.
class Loader {
 public:
  Loader(std::string_view text, const fs::path& path, const std::vector<Migration>& migrations)
      : file_(path.string()), folder_((working_folder() / path).parent_path()) {
    ParsedJson parsed = parse_json(text);
    problems_ = std::move(parsed.problems);
    if (!parsed.value || !migrate(*parsed.value, migrations, problems_)) finish();
    document_ = std::move(*parsed.value);
    check_keys();
  }

  void finish() {
    if (!problems_.empty()) throw GraphError(file_, std::move(problems_));
  }

  GraphInterface interface() {
    GraphInterface out;
    if (const JsonValue* v = text_at("summary")) out.summary = v->text;
    if (const JsonValue* v = text_at("help")) out.help = v->text;
    if (const JsonValue* v = document_.find("parameters")) out.parameters = read_parameters(*v, folder_, problems_);
    if (const JsonValue* v = document_.find("presets")) out.presets = read_presets(*v, folder_, "", true, problems_);
    for (Preset& p : presets_beside(file_, problems_)) out.presets.push_back(std::move(p));
    return out;
  }

  LoadedGraph graph(const std::vector<std::string>& override_texts, const LoadOptions& options) {
    LoadedGraph out;
    GraphInterface head = interface();
    out.graph.file = file_;
    out.graph.summary = std::move(head.summary);
    out.help = std::move(head.help);
    out.parameters = std::move(head.parameters);
    out.presets = std::move(head.presets);

    const JsonValue& nodes = nodes_section();
    std::vector<Override> overrides = chosen_presets(out.presets, options.presets, problems_);
    const auto add = [&](std::vector<Override> more) {
      overrides.insert(overrides.end(), std::make_move_iterator(more.begin()), std::make_move_iterator(more.end()));
    };
    for (const fs::path& file : options.settings) add(read_settings(file, problems_));
    add(read_overrides(override_texts, working_folder(), problems_));
    NodeReading reading(options.types);
    reading.graph_folder = folder_;
    const NodeTypes types = node_types(nodes, reading);
    for (const Preset& p : out.presets)
      if (std::ranges::find(options.presets, p.name) == options.presets.end())
        check_targets(p, out.parameters, types, problems_);
    merge_members(overrides, out.parameters, types);
    set_parameters(out.parameters, overrides, types, problems_);
    GraphScope scope(out.parameters, types, problems_);
    scope.evaluate_parameters();
    Substitution substitution(scope);
    reading.seed = read_seed(substitution);
    std::vector<NodeDraft> drafts = read_nodes(nodes, overrides, reading, substitution, problems_);
    std::vector<Problem> conversions;
    connect(drafts, problems_, conversions);
    const std::vector<size_t> order = execution_order(drafts, problems_);
    read_what_waits(drafts, order, reading, scope, substitution);
    const std::set<std::string> wanted = wanted_nodes(drafts, options.only);
    if (!options.allow_unset) require_set(out.parameters, drafts, wanted);
    trace_files(drafts, order);
    if (!problems_.empty() && options.look_ahead)
      for (Problem& p : options.look_ahead(faultless(drafts, order))) problems_.push_back(std::move(p));
    finish();

    for (const Problem& p : conversions) out.conversions.push_back(describe(file_, p));
    for (const Problem& p : warnings_about(drafts, order, out.parameters, substitution.unused()))
      out.warnings.push_back(describe(file_, p));
    const bool complete = std::ranges::all_of(drafts, [](const NodeDraft& d) { return d.unset.empty(); });
    for (const size_t i : order)
      if (complete || options.allow_unset || wanted.contains(drafts[i].node.name))
        out.graph.nodes.push_back(std::move(drafts[i].node));
    return out;
  }

 private:
  void check_keys() {
    static const std::vector<std::string> keys = {"terrazzo", "summary", "help",  "parameters",
                                                  "presets",  "seed",    "nodes", "$schema"};
    for (const JsonMember& m : document_.members)
      if (std::find(keys.begin(), keys.end(), m.name) == keys.end())
        problems_.push_back(
            {m.place, "", fmt::format("unknown key {}{}", in_quotes(m.name), suggestion(m.name, keys))});
  }

  const JsonValue* text_at(std::string_view key) {
    const JsonValue* v = document_.find(key);
    if (!v || v->is_text()) return v;
    problems_.push_back({v->place, fmt::format("\"{}\"", key), "expected a text, found " + found(*v)});
    return nullptr;
  }

  const JsonValue& nodes_section() {
    static const JsonValue none;
    const JsonValue* nodes = document_.find("nodes");
    if (!nodes) problems_.push_back({document_.place, "", "expected \"nodes\", an object of nodes by name"});
    if (nodes && !nodes->is_object())
      problems_.push_back({nodes->place, "\"nodes\"", "expected an object of nodes by name, found " + found(*nodes)});
    return nodes ? *nodes : none;
  }

  static NodeTypes node_types(const JsonValue& nodes, const NodeReading& reading) {
    NodeTypes out;
    for (const JsonMember& m : nodes.members) {
      const JsonValue* type = m.value.find("type");
      const auto known = type ? reading.types.find(type->text) : reading.types.end();
      out.emplace_back(m.name, known == reading.types.end() ? nullptr : known->second);
    }
    return out;
  }

  /// Makes "weights.height=2" the whole map, where `weights` is no node but a parameter of the graph.
  void merge_members(std::vector<Override>& overrides, const std::vector<GraphParameter>& parameters,
                     const NodeTypes& nodes) {
    std::map<std::string, JsonValue> maps;
    for (Override& o : overrides) {
      const std::string& name = o.node.empty() ? o.name : o.node;
      const auto p = std::ranges::find_if(parameters, [&](const GraphParameter& g) { return g.param.name == name; });
      const bool is_node = std::ranges::find(nodes, name, &NodeTypes::value_type::first) != nodes.end();
      if (p == parameters.end() || is_node ||
          (p->param.type != ParamType::number_map && p->param.type != ParamType::text_map))
        continue;
      if (o.node.empty()) {
        maps[name] = o.json_for(p->param);
        continue;
      }
      JsonValue empty;
      empty.kind = JsonValue::Kind::object;
      const auto [at, is_new] = maps.try_emplace(name, p->value ? json_of(*p->value) : empty);
      const std::optional<JsonValue> merged = with_member(at->second, o.name, o, problems_);
      o.name = name;
      o.node.clear();
      if (!merged) continue;
      at->second = *merged;
      o.json = *merged;
    }
  }

  /// The graph's own seed; empty if it has none or it is not set yet.
  std::optional<int64_t> read_seed(Substitution& substitution) {
    const JsonValue* given = document_.find("seed");
    if (!given) return std::nullopt;
    const Param param{.name = "seed", .type = ParamType::integer, .min = 0};
    Diagnostics diagnostics(problems_, "\"seed\"");
    const std::optional<JsonValue> value = substitution.expand(*given, param, diagnostics);
    if (!substitution.take_lacking().nodes.empty())
      diagnostics.add(given->place, "the seed cannot be made from what nodes give: they may depend on it");
    if (!value) return std::nullopt;
    const std::optional<ParamValue> read = read_param(*value, param, folder_, diagnostics);
    return read ? std::optional(std::get<int64_t>(*read)) : std::nullopt;
  }

  /// Evaluates what is made from the forecasts of nodes: node by node, so that each can ask for earlier ones.
  void read_what_waits(std::vector<NodeDraft>& drafts, const std::vector<size_t>& order, const NodeReading& reading,
                       GraphScope& scope, Substitution& substitution) {
    std::vector<std::string> asked;
    for (const NodeDraft& d : drafts) asked.insert(asked.end(), d.asked.begin(), d.asked.end());
    if (asked.empty()) return;
    std::map<std::string, const NodeDraft*> by_name;
    for (const NodeDraft& d : drafts) by_name[d.node.name] = &d;
    const std::set<std::string> needed = needed_nodes(drafts, asked);
    std::set<std::string> incomplete;  // what is wrong with them, or is to be set, has been said or will be
    Forecasts forecasts;
    scope.set_forecasts([&](const std::string& node) -> const Forecast& {
      if (const Forecast* known = forecasts.find(node)) return *known;
      throw Error(fmt::format("what \"{}\" gives is not known before it runs", node));
    });
    for (const size_t i : order) {
      NodeDraft& d = drafts[i];
      bool complete = true;
      for (const std::string& source : d.asked) {
        complete &= !incomplete.contains(source);
        d.unset.insert(by_name[source]->unset.begin(), by_name[source]->unset.end());
      }
      if (complete && !d.waiting.empty()) read_waiting(d, reading, substitution, problems_);
      if (needed.contains(d.node.name) && !(complete && look_ahead(d, forecasts, incomplete)))
        incomplete.insert(d.node.name);
    }
    scope.evaluate_parameters();
    scope.set_forecasts({});
  }

  /// Whether all parameters and wires of the node have been read.
  static bool is_complete(const NodeDraft& draft) {
    const GraphNode& node = draft.node;
    if (!node.type || node.params.size() < node.type->params.size()) return false;
    return std::ranges::all_of(draft.ports, [&](const PortWires& p) {
      const auto wires = node.inputs.find(p.port->name);
      return wires != node.inputs.end() && wires->second.size() == p.wires.size();
    });
  }

  /// Whether all is known that can be; what the node's preflight finds wrong is a problem.
  bool look_ahead(const NodeDraft& draft, Forecasts& forecasts, const std::set<std::string>& incomplete) {
    const GraphNode& node = draft.node;
    if (!is_complete(draft)) return false;
    for (const auto& [port, wires] : node.inputs)
      for (const Wire& w : wires)
        if (incomplete.contains(w.node)) return false;
    try {
      forecasts.add(node);
      return true;
    } catch (const Errors& all) {
      for (const Error& e : all.all()) problems_.push_back(problem_of(node, e.about(), e.what()));
    } catch (const Error& e) {
      problems_.push_back(problem_of(node, e.about(), e.what()));
    }
    return false;
  }

  /// What only these nodes need; all there is if there are none or one of them is not there.
  static std::set<std::string> wanted_nodes(const std::vector<NodeDraft>& drafts,
                                            const std::vector<std::string>& only) {
    std::vector<std::string> all;
    for (const NodeDraft& d : drafts) all.push_back(d.node.name);
    const auto is_there = [&](const std::string& name) { return std::ranges::find(all, name) != all.end(); };
    return needed_nodes(drafts, only.empty() || !std::ranges::all_of(only, is_there) ? all : only);
  }

  /// Where all nodes run, also what none of them needs: it is there to be set.
  void require_set(const std::vector<GraphParameter>& parameters, const std::vector<NodeDraft>& drafts,
                   const std::set<std::string>& wanted) {
    std::set<std::string> unset;
    for (const NodeDraft& d : drafts)
      if (wanted.contains(d.node.name)) unset.insert(d.unset.begin(), d.unset.end());
    for (const GraphParameter& p : parameters)
      if (!p.value && !p.is_wrong && !p.formula && (wanted.size() == drafts.size() || unset.contains(p.param.name)))
        problems_.push_back({p.place, "parameter " + in_quotes(p.param.name),
                             fmt::format("has no default and must be set: --set {}=VALUE", p.param.name)});
  }

  /// Tells every port from which of the graph's files what comes in is made.
  static void trace_files(std::vector<NodeDraft>& drafts, const std::vector<size_t>& order) {
    std::map<std::string, std::set<std::string>> files_of;  // by node
    for (const size_t i : order) {
      GraphNode& node = drafts[i].node;
      for (const auto& [port, wires] : node.inputs)
        for (const Wire& w : wires) node.files_by[port].merge(std::set(files_of[w.node]));
      for (const auto& [given, files] : node.files_by) files_of[node.name].insert(files.begin(), files.end());
    }
  }

  /// The nodes that nothing has been said against, and that have all they need but for what others are to give.
  std::vector<GraphNode> faultless(const std::vector<NodeDraft>& drafts, const std::vector<size_t>& order) const {
    std::set<std::string> faulty;
    for (const Problem& p : problems_) faulty.insert(p.node);
    std::vector<GraphNode> out;
    for (const size_t i : order) {
      const GraphNode& node = drafts[i].node;
      if (!faulty.contains(node.name) && is_complete(drafts[i])) out.push_back(node);
    }
    return out;
  }

  static std::vector<Problem> warnings_about(const std::vector<NodeDraft>& drafts, const std::vector<size_t>& order,
                                             const std::vector<GraphParameter>& parameters,
                                             const std::vector<std::string>& unused) {
    std::vector<Problem> out;
    for (const GraphParameter& p : parameters)
      if (std::ranges::find(unused, p.param.name) != unused.end())
        out.push_back({p.place, "parameter " + in_quotes(p.param.name), "no node uses it"});
    std::vector<std::string> sinks;
    for (const NodeDraft& d : drafts)
      if (d.node.type->is_sink()) sinks.push_back(d.node.name);
    if (sinks.empty()) {
      out.push_back({{}, "", "no node is a sink: a run writes nothing"});
      return out;
    }
    const std::set<std::string> needed = needed_nodes(drafts, sinks);
    for (const size_t i : order)
      if (const GraphNode& node = drafts[i].node; !needed.contains(node.name))
        out.push_back({node.place, "node " + in_quotes(node.name), "no sink reads it; it will not run"});
    return out;
  }

  std::string file_;
  fs::path folder_;
  JsonValue document_;
  std::vector<Problem> problems_;
};

}  // namespace

LoadedGraph load_graph_text(std::string_view text, const fs::path& path, const std::vector<std::string>& overrides,
                            const LoadOptions& options) {
  return Loader(text, path, options.migrations).graph(overrides, options);
}

LoadedGraph load_graph(const fs::path& path, const std::vector<std::string>& overrides, const LoadOptions& options) {
  return load_graph_text(read_document(path), path, overrides, options);
}

GraphInterface read_interface(const fs::path& path) {
  Loader loader(read_document(path), path, document_migrations());
  GraphInterface out = loader.interface();
  loader.finish();
  return out;
}

}  // namespace terrazzo
