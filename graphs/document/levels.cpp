#include "graphs/document/levels.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/base/suggest.h"
#include "graphs/document/file_origins.h"
#include "graphs/expression/operations.h"
#include "graphs/values/convert.h"

namespace terrazzo {

namespace {

constexpr size_t most_nodes = 100000;  // nested graphs can expand small files beyond any memory
constexpr int deepest = 30;            // nesting of graphs
// Including values inserted by names and expressions; also the limit of a document's own length.
constexpr size_t most_text = size_t{64} << 20;
constexpr size_t most_parameters = 200000;  // of subgraphs; every use has its own

RoutedOverride routed(const Override* override, const std::string& path) {
  const size_t bracket = path.find('['), closed = bracket == path.npos ? 0 : path.find(']', bracket);
  const size_t slash = path.find('/', closed == path.npos ? 0 : closed);
  RoutedOverride out{override, path.substr(0, slash), "", slash == path.npos ? "" : path.substr(slash + 1)};
  out.plain = out.name.substr(0, out.name.find('['));
  return out;
}

size_t bytes_of_values(const Params& params) {
  size_t sum = 0;
  for (const auto& [name, value] : params) sum += expression::bytes_of(value);
  return sum;
}

/// Whether the draft has a value for the parameter that could not be read yet.
bool is_waiting(const NodeDraft& use, const std::string& parameter) {
  return std::ranges::find(use.waiting, parameter, &NodeEntry::name) != use.waiting.end();
}

void bind(GraphParameter& p, const NodeDraft& use) {
  const std::string& name = p.param.name;
  if (!use.node.places.contains(name)) {
    // The default of a `seed` may come from the enclosing graph.
    const auto value = use.node.params.find(name);
    if (value != use.node.params.end() && p.param.type != ParamType::path) p.value = value->second;
    return;
  }
  p.formula.reset();
  p.pending.reset();
  p.value.reset();
  p.overridden = true;
  if (const auto value = use.node.params.find(name); value != use.node.params.end()) {
    p.value = value->second;
    p.as_written = text_of(*p.value);
  } else if (is_waiting(use, name) || !use.unset.empty()) {
    p.pending = Lacking{use.unset, use.asked};
  } else {
    p.is_wrong = true;
  }
}

}  // namespace

void bind_parameters(Level& level) {
  if (!level.use) return;
  for (GraphParameter& p : level.names.parameters) bind(p, *level.use);
}

Level& Levels::read(std::unique_ptr<Level> root, const std::vector<Override>& overrides) {
  Level& out = *levels_.emplace_back(std::move(root));
  std::vector<RoutedOverride> of_nodes;
  for (const Override& o : overrides)
    if (!o.node.empty()) of_nodes.push_back(routed(&o, o.node));
  read_level(out, of_nodes);
  return out;
}

void Levels::read_level(Level& level, const std::vector<RoutedOverride>& overrides) {
  const size_t before = problems_.size();
  by_path_.emplace(level.path, &level);
  level.reading.known = &types_;
  level.reading.graph_names = &level.graph->document->graph_names;
  level.reading.graph_folder = level.graph->folder;
  if (level.graph->json->find("seed")) {
    level.reading.seed = read_seed(level);
  } else if (level.outer) {
    level.reading.seed = level.outer->reading.seed;
    level.reading.seed_path = level.outer->reading.seed_path + level.use->local + "/";
  }
  std::map<std::string, std::vector<RoutedOverride>> by_node;
  for (const RoutedOverride& o : overrides) by_node[o.plain].push_back(o);
  if (const JsonValue* nodes = level.graph->json->find("nodes"))
    for (const JsonMember& m : nodes->members) {
      level.positions.emplace(m.name, level.items.size());
      level.items.emplace_back(m.name, std::vector<NodeInstance>());
      const auto its = by_node.find(m.name);
      read_item(level, m, its == by_node.end() ? std::vector<RoutedOverride>() : its->second);
    }
  refuse_unknown(level, overrides);
  read_outputs(level);
  set_file(problems_, before, level.graph->file);
}

void Levels::refuse_unknown(const Level& level, const std::vector<RoutedOverride>& overrides) {
  if (overrides.empty()) return;
  std::vector<std::string> names;
  for (const auto& [name, items] : level.items) names.push_back(name);
  std::map<std::string, std::vector<std::string>> iterations_of;  // sorted, by loop
  const auto iterations_in = [&](const std::string& loop, const std::vector<NodeInstance>& items) -> const auto& {
    const auto [at, is_new] = iterations_of.try_emplace(loop);
    if (is_new)
      for (const NodeInstance& item : items) at->second.push_back(item.draft->local);
    if (is_new) std::ranges::sort(at->second);
    return at->second;
  };
  const std::string in = level.path.empty() ? "the graph" : in_quotes(level.path.substr(0, level.path.size() - 1));
  size_t hints = 0;
  for (const RoutedOverride& o : overrides) {
    const std::vector<NodeInstance>* items = level.find(o.plain);
    const auto refuse = [&](const std::string& message) {
      o.override->diagnostics(problems_).add(o.override->place, message);
    };
    const auto refuse_name = [&](const std::string& wrong, const std::vector<std::string>& known) {
      const std::string hint = hints++ < most_problems_shown ? suggestion(wrong, known) : "";
      refuse(fmt::format("{} has no node {}{}", in, in_quotes(o.name), hint));
    };
    if (!items && std::ranges::find(level.graph->inputs, o.plain, &Port::name) != level.graph->inputs.end()) {
      refuse(fmt::format("{} is an input, which takes a wire; it has no parameters", in_quotes(o.plain)));
    } else if (!items) {
      refuse_name(o.plain, names);
    } else if (o.name != o.plain) {
      const std::vector<std::string>& iterations = iterations_in(o.plain, *items);
      if (!std::ranges::binary_search(iterations, o.name)) refuse_name(o.name, iterations);
    } else if (!o.rest.empty() && !items->empty() && !items->front().inner && !items->front().draft->muted) {
      refuse(fmt::format("{} is not a graph with nodes", in_quotes(o.name)));
    }
  }
}

void Levels::read_item(Level& level, const JsonMember& member, const std::vector<RoutedOverride>& its) {
  std::vector<NodeInstance>& items = level.items.back().second;
  const std::string where = "node " + in_quotes(level.path + member.name);
  if (!is_node_name(member.name))
    problems_.push_back({member.place, where, "expected a name of letters, digits, _ and -", level.path + member.name});
  std::optional<JsonValue> loop;
  std::filesystem::path folder = level.graph->folder;
  if (const JsonValue* given = member.value.find("foreach")) loop = *given;
  for (const RoutedOverride& o : its)
    if (o.name == member.name && o.rest.empty() && o.override->name == "foreach" && o.override->json) {
      loop = o.override->json;
      folder = o.override->base;
    }
  if (!loop) return read_iteration(level, member, member.name, level.names, its, items);
  Diagnostics diagnostics(problems_, where + ", \"foreach\"");
  Lacking lacking;
  const size_t before = made_from_.size();
  const auto iterations = read_loop(*loop, folder, *level.names.substitution, diagnostics, lacking, made_from_);
  const std::set<std::string> names = parameters_in(*loop);
  for (size_t i = before; i < made_from_.size(); i++) {
    made_from_[i].node = level.path + member.name;
    made_from_[i].set_by = settables_behind(level, names);
  }
  unset_for_loops_.insert(lacking.unset.begin(), lacking.unset.end());
  if (!iterations) return;
  std::map<std::string, std::vector<size_t>> by_name;  // positions in `its`
  for (size_t i = 0; i < its.size(); i++) by_name[its[i].name].push_back(i);
  for (const LoopIteration& iteration : *iterations) {
    if (is_full_) return;
    const std::string local = fmt::format("{}[{}]", member.name, iteration.label);
    std::vector<size_t> positions = by_name[member.name];
    if (const auto own = by_name.find(local); own != by_name.end()) {
      positions.insert(positions.end(), own->second.begin(), own->second.end());
      std::ranges::sort(positions);
    }
    std::vector<RoutedOverride> of_iteration;
    for (const size_t i : positions) of_iteration.push_back(its[i]);
    if (NodeScope* names = names_of_iteration(level, iteration, diagnostics))
      read_iteration(level, member, local, *names, of_iteration, items);
  }
  for (const NodeInstance& item : items) item.draft->loop_names = names;
}

/// Null after a problem.
NodeScope* Levels::names_of_iteration(Level& level, const LoopIteration& iteration, Diagnostics& diagnostics) {
  for (const GraphParameter& v : iteration.variables)
    if (level.names.scope->look_up(v.param.name)) {
      diagnostics.add(v.place, fmt::format("the graph has a parameter {} already; choose another name with \"as\"",
                                           in_quotes(v.param.name)));
      return nullptr;
    }
  NodeScope& out = *level.iterations.emplace_back(std::make_unique<NodeScope>());
  out.parameters = iteration.variables;
  out.scope = std::make_unique<GraphScope>(out.parameters, *level.names.scope);
  out.substitution = std::make_unique<Substitution>(*out.scope);
  return &out;
}

void Levels::read_iteration(Level& level, const JsonMember& member, const std::string& local, NodeScope& names,
                            const std::vector<RoutedOverride>& overrides, std::vector<NodeInstance>& items) {
  if (is_full_) return;
  const auto refuse = [&](const std::string& message) {
    problems_.push_back({member.place, "", message});
    is_full_ = true;
  };
  if (nodes_.size() + others_.size() >= most_nodes)
    return refuse(fmt::format("a graph may have at most {} nodes, including those of its subgraphs", most_nodes));
  std::vector<const Override*> own;
  std::vector<RoutedOverride> deeper;
  for (const RoutedOverride& o : overrides) {
    if (o.name != o.plain && o.name != local) continue;
    if (o.rest.empty())
      own.push_back(o.override);
    else
      deeper.push_back(routed(o.override, o.rest));
  }
  const JsonValue* type = member.value.find("type");
  const bool is_plain_type = !type || !type->is_text() || types_.find(type->text);
  const size_t before = problems_.size();
  const Subgraph* graph = is_plain_type ? nullptr : graphs_.find(*type, *level.graph);
  const bool is_graph = graph || (!is_plain_type && Subgraphs::is_file(type->text));
  NodeDraft draft;
  draft.local = local;
  draft.node.name = level.path + local;
  draft.node.place = member.place;
  draft.node.file = level.graph->file;
  draft.level = &level;
  draft.reading = &level.reading;
  draft.substitution = names.substitution.get();
  if (graph) {
    std::vector<std::string> given;
    for (const JsonMember& m : member.value.members) given.push_back(m.name);
    for (const Override* o : own) given.push_back(o->name.substr(0, o->name.find('.')));
    draft.node.type = &use_types_.emplace_back(type_of_use(*graph, given));
  }
  if (graph || !is_graph) read_node(draft, member.value, own, problems_);
  text_ += bytes_of_values(draft.node.params);
  if (text_ > most_text)
    return refuse("the values of all nodes, with the names in them replaced, are longer than 64 MiB in all");
  if (graph) parameters_ += graph->parameters.size();
  if (parameters_ > most_parameters)
    return refuse(fmt::format("the subgraphs of a graph may have at most {} parameters together", most_parameters));
  for (size_t i = before; i < problems_.size(); i++) {
    if (problems_[i].where.empty()) problems_[i].where = "node " + in_quotes(draft.node.name);
  }
  set_node(problems_, before, draft.node.name);
  const bool runs = !is_graph && !draft.muted;
  NodeDraft& kept = (runs ? nodes_ : others_).emplace_back(std::move(draft));
  Level* inner = graph && !kept.muted ? read_use(level, kept, *graph, deeper) : nullptr;
  items.push_back({&kept, inner});
}

Level* Levels::read_use(Level& outer, NodeDraft& use, const Subgraph& graph,
                        const std::vector<RoutedOverride>& overrides) {
  std::string chain = graph.title;
  int depth = 0;
  for (const Level* level = &outer; level; level = level->outer, depth++) {
    chain = level->graph->title + " -> " + chain;
    if (level->graph != &graph && depth < deepest) continue;
    const std::string message = level->graph == &graph ? "the graph is part of itself: " + chain
                                                       : fmt::format("graphs nested more than {} deep", deepest);
    problems_.push_back({use.node.place, "node " + in_quotes(use.node.name), message, use.node.name, use.node.file});
    return nullptr;
  }
  Level& level = *levels_.emplace_back(std::make_unique<Level>());
  level.graph = &graph;
  level.outer = &outer;
  level.use = &use;
  level.path = use.node.name + "/";
  level.names.parameters = graph.parameters;
  bind_parameters(level);
  level.names.scope = std::make_unique<GraphScope>(level.names.parameters, graph.sources, level.path, problems_);
  level.names.substitution = std::make_unique<Substitution>(*level.names.scope);
  const size_t before = problems_.size();
  level.names.scope->evaluate_parameters();
  set_file(problems_, before, graph.file);
  read_level(level, overrides);
  return &level;
}

void Levels::read_outputs(Level& level) {
  for (const GraphOutput& o : level.graph->outputs) {
    const Port& port = output_ports_.emplace_back(o.port);
    PortWires wires{&port, {}, Diagnostics(problems_, "output " + in_quotes(port.name))};
    std::set<std::string> named, unset;
    const auto from = expand_wires(o.from, *level.names.substitution, wires.diagnostics, named, unset);
    if (from && is_wire(*from))
      wires.wires.push_back(wire_end(*from, wires.diagnostics));
    else if (from)
      wires.diagnostics.add(from->place, "expected a wire such as \"@node\" or \"@node.port\", found " + found(*from));
    level.outputs.emplace(port.name, std::move(wires));
  }
}

/// The graph's own seed; empty if it is not set yet.
std::optional<int64_t> Levels::read_seed(Level& level) {
  const JsonValue& given = *level.graph->json->find("seed");
  const Param param{.name = "seed", .type = ParamType::integer, .min = 0};
  Diagnostics diagnostics(problems_, "\"seed\"");
  Substitution& substitution = *level.names.substitution;
  const std::optional<JsonValue> value = substitution.expand(given, param, diagnostics);
  if (!substitution.take_lacking().nodes.empty())
    diagnostics.add(given.place, "the seed cannot depend on the results of nodes, which may depend on it");
  if (!value) return std::nullopt;
  const std::optional<ParamValue> read = read_param(*value, param, level.graph->folder, diagnostics);
  return read ? std::optional(std::get<int64_t>(*read)) : std::nullopt;
}

}  // namespace terrazzo
