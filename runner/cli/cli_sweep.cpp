#include "runner/cli/cli_sweep.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>

#include <fmt/format.h>

#include "core/base/suggest.h"
#include "core/file/atomic_file.h"
#include "graphs/text/problem.h"
#include "nodes/sink/compare.h"
#include "nodes/sink/export_report.h"
#include "runner/cli/cli_commands.h"
#include "runner/plan/memory_graph.h"
#include "runner/report/html_report.h"
#include "runner/terminal/console.h"

namespace terrazzo {

namespace {

namespace fs = std::filesystem;

/// Parses the name of a figure and, after a colon, which direction is better.
std::pair<std::string, std::string> split_figure(const std::string& text) {
  const size_t colon = text.find(':');
  return {text.substr(0, colon), colon == text.npos ? "" : text.substr(colon + 1)};
}

std::optional<double> value_in(const Report& report, const std::string& figure) {
  const auto at = std::ranges::find(report.figures(), figure, &Report::Figure::name);
  if (at == report.figures().end() || !std::holds_alternative<double>(at->value)) return std::nullopt;
  return std::get<double>(at->value);
}

std::string as_csv(const Table& table) {
  std::string out;
  for (const auto& row : table) {
    std::vector<std::string> cells;
    for (const std::string& cell : row) cells.push_back(csv_field(cell));
    out += fmt::format("{}\n", fmt::join(cells, ","));
  }
  return out;
}

/// The first node of a type, in the document's order; empty if there is none.
std::string first_of(const std::string& type, const Graph& graph) {
  const auto at = std::ranges::find_if(graph.nodes, [&](const GraphNode& n) { return n.type->name == type; });
  return at == graph.nodes.end() ? "" : at->name;
}

}  // namespace

void add_variation_flags(Command& command, SweepFlags& flags) {
  command
      .add_option("--sweep", &flags.sweeps,
                  "Runs the graph with each of several values: seed=1..64, scale=0..1:0.25, size=512,1024; of several "
                  "sweeps, with every combination")
      .takes("NAME=VALUES")
      .repeated();
  command
      .add_option("--table", &flags.table,
                  "Runs the graph with each row of a table: a CSV file whose first line has the names, or a JSON "
                  "list of objects")
      .takes("FILE");
}

void add_sweep_flags(Command& command, SweepFlags& flags) {
  add_variation_flags(command, flags);
  command
      .add_option("--sheet", &flags.sheet, "With a sweep or table: writes a contact sheet, a picture or a page (.html)")
      .takes("FILE");
  command.add_option("--figures", &flags.figures, "With a sweep or table: writes the figures of all variations")
      .takes("FILE.csv");
  command
      .add_option("--best", &flags.best,
                  "With a sweep or table: names the variation with the best figure, such as swd; NAME:min or "
                  "NAME:max say which way is better")
      .takes("FIGURE");
}

Sweep::Sweep(const SweepFlags& flags) : flags_(flags) {
  try {
    const std::vector<Variation> columns = swept(flags.sweeps);
    variations_ = combined(flags.table.empty() ? std::vector<Variation>() : read_table(flags.table), columns);
  } catch (const GraphError& e) {
    throw UsageError(fmt::format("--table {}", e.what()));
  } catch (const Error& e) {
    throw UsageError(fmt::format("{}: {}", flags.table.empty() ? "--sweep" : "--sweep, --table", e.what()));
  }
  check_sheet(flags.sheet);
  const std::string way = split_figure(flags.best).second;
  if (!way.empty() && way != "min" && way != "max")
    throw UsageError(fmt::format("--best {}: expected min or max after the colon", flags.best));
}

std::vector<std::string> Sweep::labels() const {
  std::vector<std::string> out;
  for (const Variation& v : variations_) out.push_back(v.label());
  return out;
}

Graph Sweep::load(const std::function<Graph(const std::vector<Override>&)>& load) {
  GraphMerger merger;
  Graph first;
  std::map<std::vector<std::pair<std::string, std::string>>, size_t> loaded;  // by values
  for (size_t i = 0; i < variations_.size(); i++) {
    const auto [same, is_new] = loaded.emplace(variations_[i].values, i);
    if (!is_new) {
      merger.add_again(same->second);
      continue;
    }
    Graph graph = load(variations_[i].overrides());
    if (i == 0) first = graph;
    merger.add(std::move(graph), variations_[i].label());
  }
  MergedGraph all = merger.merged();
  names_ = std::move(all.names);
  Nodes nodes;
  for (const GraphNode& n : all.graph.nodes) nodes.emplace(n.name, &n);
  check_paths(first, nodes);
  targets_.clear();
  kept_.clear();
  std::vector<GraphNode> added;
  if (!flags_.sheet.empty()) add_sheet(first, nodes, added);
  if (!flags_.figures.empty() || !flags_.best.empty()) add_comparisons(first, nodes, added);
  std::ranges::move(added, std::back_inserter(all.graph.nodes));
  return std::move(all.graph);
}

Graph Sweep::load(const GraphFlags& values, const LoadOptions& options,
                  const std::function<void(const std::string&)>& warn) {
  std::set<std::string> warned;
  return load([&](const std::vector<Override>& overrides) {
    LoadedGraph loaded = values.load(options, overrides);
    for (const Problem& w : loaded.warnings)
      if (const std::string text = describe(values.graph, w); warned.insert(text).second) warn(text);
    return std::move(loaded.graph);
  });
}

/// Variations must not overwrite each other's files. Sizes and materials in a path may distinguish them; the plan
/// checks those.
void Sweep::check_paths(const Graph& first, const Nodes& nodes) const {
  std::map<std::pair<std::string, std::string>, size_t> writers;  // the first variation, by node and path
  for (size_t v = 0; v < names_.size(); v++)
    for (const auto& [name, merged_name] : names_[v]) {
      const GraphNode& n = *nodes.at(merged_name);
      const auto path = n.params.find("path");
      if (!n.type->is_sink() || path == n.params.end()) continue;
      const std::string& pattern = std::get<std::string>(path->second);
      const auto holds = [&](const char* place) { return pattern.find(place) != pattern.npos; };
      if (holds("{width}") || holds("{height}") || holds("{material}")) continue;
      const size_t writer = writers.try_emplace({name, pattern}, v).first->second;
      if (names_[writer].at(name) == merged_name) continue;  // it is the same node, and runs once
      throw UsageError(fmt::format("node \"{}\" would write {} for {} and for {}; {}", name, pattern,
                                   variations_[writer].label(), variations_[v].label(), way_apart(first)));
    }
}

/// A hint on placeholders that distinguish all variations in a path.
std::string Sweep::way_apart(const Graph& graph) const {
  std::string sum, unnamed;
  for (const std::string& name : names_that_vary()) {
    const bool is_parameter = std::ranges::find(graph.settings, name, &GraphSetting::name) != graph.settings.end();
    std::string& list = is_parameter ? sum : unnamed;
    list += list.empty() ? "" : is_parameter ? " + '-' + " : ", ";
    list += is_parameter ? name : fmt::format("\"{}\"", name);
  }
  if (!unnamed.empty())
    return fmt::format("a path can tell them apart only by parameters of the graph: declare one for {}", unnamed);
  return fmt::format("let its path tell them apart, as --set \"out=='out/' + {}\" does where the path begins with $out",
                     sum);
}

/// The names with several values, in order.
std::vector<std::string> Sweep::names_that_vary() const {
  std::vector<std::string> names;
  std::map<std::string, std::set<std::string>> values;
  std::map<std::string, size_t> times;
  for (const Variation& v : variations_)
    for (const auto& [name, value] : v.values) {
      if (times[name]++ == 0) names.push_back(name);
      values[name].insert(value);
    }
  std::erase_if(names, [&](const std::string& n) { return values[n].size() == 1 && times[n] == variations_.size(); });
  return names;
}

/// Calls `make` for each variation's node `base`; once for shared nodes.
template <typename T>
std::vector<T> Sweep::of_each(const std::string& base, const std::function<T(const std::string& node)>& make) const {
  std::map<std::string, T> made;
  std::vector<T> out;
  for (size_t v = 0; v < names_.size(); v++) {
    const auto node = names_[v].find(base);
    if (node == names_[v].end())
      throw UsageError(fmt::format(
          "--sheet, --figures, --best: {} has no node \"{}\", as its sources cannot be read; leave this variation out",
          variations_[v].label(), base));
    auto at = made.find(node->second);
    if (at == made.end()) at = made.emplace(node->second, make(node->second)).first;
    out.push_back(at->second);
  }
  return out;
}

/// Shows the output of the variations' first export: images unchanged, materials lit.
void Sweep::add_sheet(const Graph& document, const Nodes& nodes, std::vector<GraphNode>& added) {
  const std::string base = first_of("export", document);
  if (base.empty()) throw UsageError("--sheet: the graph has no export whose pictures could be shown");
  pictures_ = of_each<Wire>(base, [&](const std::string& node) {
    const Wire& wire = nodes.at(node)->inputs.at("material").front();
    if (nodes.at(wire.node)->type->find_output(wire.port)->type == ValueType::image) return wire;
    added.push_back(memory_node("lit for " + node, "preview", {{"size", Size{512, 0}}}));
    added.back().inputs["material"] = {wire};
    return Wire{added.back().name, "image"};
  });
  if (is_page(flags_.sheet)) {
    for (const Wire& w : pictures_) kept_.push_back(w.node);
    return;
  }
  // One row per combination of all sweeps but the last; without sweeps about as many rows as columns.
  const bool is_grid = flags_.sweeps.size() > 1;
  const double count = double(is_grid ? swept({flags_.sweeps.back()}).size() : variations_.size());
  const auto columns = int64_t(is_grid ? count : std::ceil(std::sqrt(count)));
  GraphNode sheet = memory_node("contact sheet", "contact_sheet",
                                {{"columns", std::clamp<int64_t>(columns, 1, 256)}, {"captions", Texts(labels())}});
  sheet.inputs["images"] = pictures_;
  GraphNode file = memory_node("contact sheet file", "export", {{"path", fs::absolute(flags_.sheet).string()}});
  file.inputs["material"] = {{sheet.name, "image"}};
  targets_.push_back(file.name);
  added.push_back(std::move(sheet));
  added.push_back(std::move(file));
}

/// The graph's own compare node, or one that compares resolved results with their exemplar.
void Sweep::add_comparisons(const Graph& document, const Nodes& nodes, std::vector<GraphNode>& added) {
  const std::string own = first_of("compare", document), resolved = first_of("resolve_uv", document);
  if (own.empty() && resolved.empty())
    throw UsageError(
        "--figures and --best need a compare node in the graph, or a resolve_uv whose result can be compared");
  comparisons_ = of_each<std::string>(own.empty() ? resolved : own, [&](const std::string& node) {
    if (!own.empty()) return node;
    added.push_back(memory_node("figures of " + node, "compare", {}));
    GraphNode& figures = added.back();
    figures.inputs["exemplar"] = nodes.at(node)->inputs.at("material");
    figures.inputs["output"] = {{node, "material"}};
    figures.inputs["uv"] = nodes.at(node)->inputs.at("uv");
    return figures.name;
  });
  kept_.insert(kept_.end(), comparisons_.begin(), comparisons_.end());
  if (!flags_.best.empty()) check_best(nodes, added);
}

/// Finds a misspelt figure now rather than after hours of work.
void Sweep::check_best(const Nodes& nodes, const std::vector<GraphNode>& added) {
  using Better = ComparedFigure::Better;
  const auto [name, way] = split_figure(flags_.best);
  std::vector<std::string> known;
  std::optional<Better> better;
  for (const std::string& comparison : comparisons_) {
    const auto own = nodes.find(comparison);
    const GraphNode& node = own != nodes.end() ? *own->second : *std::ranges::find(added, comparison, &GraphNode::name);
    for (const ComparedFigure& f :
         compared_figures(node.params, node.inputs.contains("uv"), node.inputs.contains("labels"))) {
      if (f.name == name) better = f.better;
      if (std::ranges::find(known, f.name) == known.end()) known.push_back(f.name);
    }
  }
  if (!better) throw UsageError(fmt::format("--best {}: there is no such figure{}", name, suggestion(name, known)));
  if (way.empty() && *better == Better::neither)
    throw UsageError(fmt::format("--best {0}: which way is better? {0}:min or {0}:max", name));
  higher_is_better_ = way.empty() ? *better == Better::higher : way == "max";
}

std::vector<std::string> Sweep::names_of(const std::vector<std::string>& nodes) const {
  std::set<std::string> out;
  for (const std::string& node : nodes) {
    bool is_there = false;  // in some variation; others may lack it
    for (const auto& names : names_)
      for (const auto& [name, merged] : names) {
        if (!stands_for(node, name)) continue;
        is_there = true;
        out.insert(merged);
      }
    if (!is_there) out.insert(node);
  }
  return {out.begin(), out.end()};
}

std::map<std::string, std::string> Sweep::of_one_variation() const {
  std::map<std::string, std::string> out;
  std::set<std::string> shared;
  for (size_t v = 0; v < names_.size(); v++)
    for (const auto& [name, merged] : names_[v])
      if (!out.emplace(merged, variations_[v].label()).second) shared.insert(merged);
  for (const std::string& node : shared) out.erase(node);
  return out;
}

std::vector<const Report*> Sweep::reports(const RunResult& result) const {
  std::vector<const Report*> out;
  for (const std::string& node : comparisons_) {
    const auto kept = result.kept.find(node);
    if (kept != result.kept.end()) out.push_back(std::get<ReportPtr>(kept->second.at("report")).get());
  }
  return out;
}

void Sweep::report(const RunResult& result) const {
  if (!result.ok()) return;
  const std::vector<const Report*> figures = reports(result);
  Table table;
  std::vector<std::string>& head = table.emplace_back();
  for (const Variation& v : variations_)
    for (const auto& [name, value] : v.values)
      if (std::ranges::find(head, name) == head.end()) head.push_back(name);
  const size_t values = head.size();
  if (!figures.empty())
    for (const Report::Figure& f : figures.front()->figures()) head.push_back(f.name);
  for (size_t i = 0; i < variations_.size(); i++) {
    std::vector<std::string> row(table.front().size());
    for (const auto& [name, value] : variations_[i].values)
      row[size_t(std::ranges::find(table.front(), name) - table.front().begin())] = value;
    if (!figures.empty())
      for (size_t f = 0; f < figures[i]->figures().size() && values + f < row.size(); f++)
        row[values + f] = value_text(figures[i]->figures()[f]);
    table.push_back(std::move(row));
  }
  if (!figures.empty()) print_result("{}", aligned(table));
  if (!flags_.figures.empty()) {
    write_whole_file(flags_.figures, as_csv(table));
    print_message("wrote {}\n", flags_.figures);
  }
  if (is_page(flags_.sheet)) {
    std::vector<Report::Picture> pictures;
    for (size_t i = 0; i < variations_.size(); i++) {
      const Value& picture = result.kept.at(pictures_[i].node).at(pictures_[i].port);
      pictures.push_back({variations_[i].label(), std::get<ImagePtr>(picture)});
    }
    write_variations_page("Variations", table, pictures, flags_.sheet);
    print_message("wrote {}\n", flags_.sheet);
  }
  if (!flags_.best.empty()) tell_best(figures);
}

void Sweep::tell_best(const std::vector<const Report*>& reports) const {
  const std::string name = split_figure(flags_.best).first;
  size_t best = reports.size();
  double value = 0;
  for (size_t i = 0; i < reports.size(); i++) {
    const std::optional<double> here = value_in(*reports[i], name);
    if (!here) continue;
    if (best == reports.size() || (higher_is_better_ ? *here > value : *here < value)) {
      best = i;
      value = *here;
    }
  }
  if (best == reports.size()) throw UsageError(fmt::format("--best {}: no variation has this figure", name));
  print_result("best by {}: {} ({})\n", name, variations_[best].label(), value);
}

}  // namespace terrazzo
