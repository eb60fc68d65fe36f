#include "graphs/document/level.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/base/suggest.h"
#include "graphs/document/convert.h"

namespace terrazzo {

namespace {

constexpr size_t most_nodes = 100000;  // small files can hold graphs within graphs that are more than any memory
constexpr int deepest = 30;            // graphs within graphs

/// What an override of a graph is for: "walls" of "walls[brick]/layout", and what follows.
struct Step {
  std::string name;   ///< "walls[brick]"
  std::string plain;  ///< "walls"
  std::string rest;   ///< "layout"
};

Step first_step(const std::string& path) {
  const size_t bracket = path.find('['), closed = bracket == path.npos ? 0 : path.find(']', bracket);
  const size_t slash = path.find('/', closed == path.npos ? 0 : closed);
  Step out{path.substr(0, slash), "", slash == path.npos ? "" : path.substr(slash + 1)};
  out.plain = out.name.substr(0, out.name.find('['));
  return out;
}

/// Whether this draft has been told its value for the parameter and could not read it yet.
bool is_waiting(const NodeDraft& use, const std::string& parameter) {
  return std::ranges::find(use.waiting, parameter, &NodeEntry::name) != use.waiting.end();
}

void bind(GraphParameter& p, const NodeDraft& use) {
  const std::string& name = p.param.name;
  if (!use.node.places.contains(name)) {
    // The default of a `seed` may come from the graph around it.
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
  const auto bind_all = [&](std::vector<GraphParameter>& parameters) {
    // A loop's variables follow the level's own parameters.
    for (size_t i = 0; i < level.names.parameters.size(); i++) bind(parameters[i], *level.use);
  };
  bind_all(level.names.parameters);
  for (const std::unique_ptr<Names>& round : level.rounds) bind_all(round->parameters);
}

Level& Levels::read(std::unique_ptr<Level> root, const std::vector<Override>& overrides) {
  Level& out = *levels_.emplace_back(std::move(root));
  std::vector<RoutedOverride> routed;
  for (const Override& o : overrides)
    if (!o.node.empty()) routed.push_back({&o, o.node});
  read_level(out, routed);
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
  if (const JsonValue* nodes = level.graph->json->find("nodes"))
    for (const JsonMember& m : nodes->members) {
      level.positions.emplace(m.name, level.items.size());
      level.items.emplace_back(m.name, std::vector<Item>());
      read_item(level, m, overrides);
    }
  refuse_unknown(level, overrides);
  read_outputs(level);
  set_file(problems_, before, level.graph->file);
}

void Levels::refuse_unknown(const Level& level, const std::vector<RoutedOverride>& overrides) {
  std::vector<std::string> names;
  for (const auto& [name, items] : level.items) names.push_back(name);
  for (const RoutedOverride& o : overrides) {
    const Step step = first_step(o.path);
    const std::vector<Item>* items = level.find(step.plain);
    const std::string in = level.path.empty() ? "the graph" : in_quotes(level.path.substr(0, level.path.size() - 1));
    const auto refuse = [&](const std::string& message) {
      o.override->diagnostics(problems_).add(o.override->place, message);
    };
    if (!items) {
      refuse(fmt::format("{} has no node {}{}", in, in_quotes(step.name), suggestion(step.plain, names)));
    } else if (step.name != step.plain) {
      std::vector<std::string> rounds;
      for (const Item& item : *items) rounds.push_back(item.draft->local);
      if (std::ranges::find(rounds, step.name) == rounds.end())
        refuse(fmt::format("{} has no node {}{}", in, in_quotes(step.name), suggestion(step.name, rounds)));
    } else if (!step.rest.empty() && !items->empty() && !items->front().inner && !items->front().draft->muted) {
      refuse(fmt::format("{} is no graph that has nodes", in_quotes(step.name)));
    }
  }
}

void Levels::read_item(Level& level, const JsonMember& member, const std::vector<RoutedOverride>& overrides) {
  std::vector<RoutedOverride> its;
  for (const RoutedOverride& o : overrides)
    if (first_step(o.path).plain == member.name) its.push_back(o);
  std::vector<Item>& items = level.items.back().second;
  const std::string where = "node " + in_quotes(level.path + member.name);
  if (!is_node_name(member.name))
    problems_.push_back({member.place, where, "expected a name of letters, digits, _ and -", level.path + member.name});
  std::optional<JsonValue> loop;
  std::filesystem::path folder = level.graph->folder;
  if (const JsonValue* given = member.value.find("foreach")) loop = *given;
  for (const RoutedOverride& o : its)
    if (o.path == member.name && o.override->name == "foreach" && o.override->json) {
      loop = o.override->json;
      folder = o.override->base;
    }
  if (!loop) return read_round(level, member, member.name, level.names, its, items);
  Diagnostics diagnostics(problems_, where + ", \"foreach\"");
  Lacking lacking;
  const size_t before = made_from_.size();
  const auto rounds = read_loop(*loop, folder, *level.names.substitution, diagnostics, lacking, made_from_);
  for (size_t i = before; i < made_from_.size(); i++) made_from_[i].node = level.path + member.name;
  unset_for_loops_.insert(lacking.unset.begin(), lacking.unset.end());
  if (!rounds) return;
  for (const LoopRound& round : *rounds)
    if (Names* names = names_of_round(level, round, diagnostics))
      read_round(level, member, fmt::format("{}[{}]", member.name, round.label), *names, its, items);
  std::set<std::string> files;
  for (const JsonMember& m : loop->members) files.merge(level.names.substitution->paths_in(m.value));
  for (const Item& item : items) item.draft->loop_files = files;
}

/// Null after a problem.
Names* Levels::names_of_round(Level& level, const LoopRound& round, Diagnostics& diagnostics) {
  for (const GraphParameter& v : round.variables)
    if (std::ranges::find(level.graph->parameters, v.param.name,
                          [](const GraphParameter& p) { return p.param.name; }) != level.graph->parameters.end()) {
      diagnostics.add(v.place, fmt::format("the graph has a parameter {} already; choose another name with \"as\"",
                                           in_quotes(v.param.name)));
      return nullptr;
    }
  Names& out = *level.rounds.emplace_back(std::make_unique<Names>());
  out.parameters = level.names.parameters;
  out.parameters.insert(out.parameters.end(), round.variables.begin(), round.variables.end());
  out.scope = std::make_unique<GraphScope>(out.parameters, level.graph->sources, level.path, problems_);
  out.substitution = std::make_unique<Substitution>(*out.scope);
  return &out;
}

void Levels::read_round(Level& level, const JsonMember& member, const std::string& local, Names& names,
                        const std::vector<RoutedOverride>& overrides, std::vector<Item>& items) {
  if (is_full_) return;
  if (nodes_.size() + others_.size() >= most_nodes) {
    problems_.push_back({member.place, "",
                         fmt::format("a graph may have at most {} nodes, those of its subgraphs "
                                     "included",
                                     most_nodes)});
    is_full_ = true;
    return;
  }
  std::vector<const Override*> own;
  std::vector<RoutedOverride> deeper;
  for (const RoutedOverride& o : overrides) {
    const Step step = first_step(o.path);
    if (step.name != step.plain && step.name != local) continue;
    if (step.rest.empty())
      own.push_back(o.override);
    else
      deeper.push_back({o.override, step.rest});
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
                                                       : fmt::format("more than {} graphs within one another", deepest);
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
    diagnostics.add(given.place, "the seed cannot be made from what nodes give: they may depend on it");
  if (!value) return std::nullopt;
  const std::optional<ParamValue> read = read_param(*value, param, level.graph->folder, diagnostics);
  return read ? std::optional(std::get<int64_t>(*read)) : std::nullopt;
}

void Levels::set_forecasts(const GraphScope::Forecasts& forecasts) {
  for (const std::unique_ptr<Level>& level : levels_) {
    level->names.scope->set_forecasts(forecasts);
    for (const std::unique_ptr<Names>& round : level->rounds) round->scope->set_forecasts(forecasts);
  }
}

void Levels::read_what_waits(Level& level, const std::set<std::string>& known) {
  if (!level.use) return;
  read_what_waits(*level.outer, known);
  NodeDraft& use = *level.use;
  if (use.waiting.empty() || !std::ranges::includes(known, use.asked)) return;
  const size_t before = problems_.size();
  read_waiting(use, problems_);
  set_file(problems_, before, use.node.file);
  use.asked.clear();
  bind_parameters(level);
}

}  // namespace terrazzo
