#include "runner/cli/cli_sweep.h"

#include <algorithm>
#include <cmath>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "core/base/suggest.h"
#include "core/file/atomic_file.h"
#include "core/image/image_file.h"
#include "graphs/document/problem.h"
#include "nodes/sink/export_report.h"
#include "runner/cli/cli_commands.h"
#include "runner/cli/console.h"
#include "runner/engine/memory_graph.h"
#include "runner/report/html_report.h"

namespace terrazzo {

namespace {

namespace fs = std::filesystem;

bool is_page(const fs::path& path) {
  return path.extension() == ".html" || path.extension() == ".htm";
}

const GraphNode& node_in(const Graph& graph, const std::string& name) {
  return *graph.find(name);
}

/// The name of a figure and, behind a colon, which way is better.
std::pair<std::string, std::string> split_figure(const std::string& text) {
  const size_t colon = text.find(':');
  return {text.substr(0, colon), colon == text.npos ? "" : text.substr(colon + 1)};
}

std::optional<double> value_in(const Report& report, const std::string& figure) {
  const auto at = std::ranges::find(report.figures(), figure, &Report::Figure::name);
  if (at == report.figures().end() || !std::holds_alternative<double>(at->value)) return std::nullopt;
  return std::get<double>(at->value);
}

std::string shown(const Report::Figure& f) {
  return std::holds_alternative<double>(f.value) ? fmt::format("{}", std::get<double>(f.value))
                                                 : std::get<std::string>(f.value);
}

using Table = std::vector<std::vector<std::string>>;

std::string aligned(const Table& table) {
  std::vector<size_t> widths;
  for (const auto& row : table) {
    widths.resize(std::max(widths.size(), row.size()), 0);
    for (size_t c = 0; c < row.size(); c++) widths[c] = std::max(widths[c], row[c].size());
  }
  std::string out;
  for (const auto& row : table) {
    std::string line;
    for (size_t c = 0; c < row.size(); c++) line += fmt::format("{:<{}}  ", row[c], widths[c]);
    line.erase(line.find_last_not_of(' ') + 1);
    out += line + "\n";
  }
  return out;
}

std::string as_csv(const Table& table) {
  std::string out;
  for (const auto& row : table) {
    std::string line;
    for (const std::string& cell : row) line += (line.empty() && &cell == &row.front() ? "" : ",") + csv_field(cell);
    out += line + "\n";
  }
  return out;
}

}  // namespace

void add_sweep_flags(CLI::App& command, SweepFlags& flags) {
  command
      .add_option("--sweep", flags.sweeps,
                  "Runs the graph with each of several values: seed=1..64, scale=0..1:0.25, size=512,1024; of several "
                  "sweeps, with every combination")
      ->type_name("NAME=VALUES")
      ->take_all()
      ->expected(1);
  command
      .add_option("--table", flags.table,
                  "Runs the graph with each row of a table: a CSV file whose first line has the names, or a JSON "
                  "list of objects")
      ->type_name("FILE");
  command
      .add_option("--sheet", flags.sheet, "Of a sweep or table: writes a contact sheet, a picture or a page (.html)")
      ->type_name("FILE");
  command.add_option("--figures", flags.figures, "Of a sweep or table: writes the figures of all variations")
      ->type_name("FILE.csv");
  command
      .add_option("--best", flags.best,
                  "Of a sweep or table: names the variation that is best by a figure, such as swd; NAME:min or "
                  "NAME:max say which way is better")
      ->type_name("FIGURE");
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
  if (!flags.sheet.empty() && !is_page(flags.sheet) && !format_from(flags.sheet))
    throw UsageError(fmt::format(
        "--sheet {}: the extension decides the format; expected .html for a page, or .png, .jpg, .tif or .exr",
        flags.sheet));
  check_writable("--sheet", flags.sheet);
  check_writable("--figures", flags.figures);
  const std::string way = split_figure(flags.best).second;
  if (!way.empty() && way != "min" && way != "max")
    throw UsageError(fmt::format("--best {}: expected min or max after the colon", flags.best));
}

std::vector<std::string> Sweep::labels() const {
  std::vector<std::string> out;
  for (const Variation& v : variations_) out.push_back(v.label());
  return out;
}

Graph Sweep::load(const std::function<Graph(const std::vector<std::string>&)>& load) {
  std::vector<Graph> graphs;
  for (const Variation& v : variations_) graphs.push_back(load(v.overrides()));
  MergedGraph all = merged(graphs, labels());
  names_ = std::move(all.names);
  Graph graph = std::move(all.graph);
  check_paths(graph);
  pictures_.clear();
  comparisons_.clear();
  targets_.clear();
  kept_.clear();
  if (!flags_.sheet.empty()) add_sheet(graph);
  if (!flags_.figures.empty() || !flags_.best.empty())
    for (size_t v = 0; v < variations_.size(); v++) comparisons_.push_back(comparison_of(graph, v));
  kept_.insert(kept_.end(), comparisons_.begin(), comparisons_.end());
  return graph;
}

/// Variations must not write over one another's files. Sizes and materials in a path may tell them apart; the plan
/// looks at those.
void Sweep::check_paths(const Graph& graph) const {
  std::map<std::pair<std::string, std::string>, std::pair<std::string, size_t>> writers;  // by base name and path
  for (size_t v = 0; v < variations_.size(); v++)
    for (const auto& [base, name] : names_[v]) {
      const GraphNode& n = node_in(graph, name);
      const auto path = n.params.find("path");
      if (!n.type->is_sink() || path == n.params.end()) continue;
      const std::string& pattern = std::get<std::string>(path->second);
      if (pattern.find("{width}") != pattern.npos || pattern.find("{height}") != pattern.npos ||
          pattern.find("{material}") != pattern.npos)
        continue;
      const auto [at, is_new] = writers.try_emplace({base, pattern}, name, v);
      if (is_new || at->second.first == name) continue;
      const std::string& swept = variations_[v].values.back().first;
      throw UsageError(
          fmt::format("node \"{}\" would write {} for {} and for {}; let its path tell them apart, as --set "
                      "\"out=='out/' + {}\" does where the path begins with $out",
                      base, pattern, variations_[at->second.second].label(), variations_[v].label(), swept));
    }
}

/// Whatever the variation's first export writes: images as they are, materials lit.
std::string Sweep::picture_of(Graph& graph, size_t variation) {
  for (const GraphNode& n : graph.nodes) {
    if (n.type->name != "export") continue;
    const bool is_of_variation =
        std::ranges::any_of(names_[variation], [&](const auto& name) { return name.second == n.name; });
    if (!is_of_variation) continue;
    const Wire wire = n.inputs.at("material").front();
    if (node_in(graph, wire.node).type->find_output(wire.port)->type == ValueType::image) {
      pictures_.push_back(wire);
      return wire.node;
    }
    GraphNode lit = memory_node(fmt::format("lit [{}]", variations_[variation].label()), "preview", {});
    lit.inputs["material"] = {wire};
    pictures_.push_back({lit.name, "image"});
    graph.nodes.push_back(std::move(lit));
    return graph.nodes.back().name;
  }
  throw UsageError("--sheet: the graph has no export whose pictures could be shown");
}

void Sweep::add_sheet(Graph& graph) {
  for (size_t v = 0; v < variations_.size(); v++) kept_.push_back(picture_of(graph, v));
  if (is_page(flags_.sheet)) return;
  kept_.clear();
  // A row for each value of all but the last sweep; else about as many rows as columns.
  const bool is_grid = flags_.sweeps.size() > 1;
  const double count = double(is_grid ? swept({flags_.sweeps.back()}).size() : variations_.size());
  const auto columns = int64_t(is_grid ? count : std::ceil(std::sqrt(count)));
  GraphNode sheet = memory_node("contact sheet", "contact_sheet",
                                {{"columns", std::clamp<int64_t>(columns, 1, 256)}, {"captions", Texts(labels())}});
  sheet.inputs["images"] = pictures_;
  GraphNode file = memory_node("contact sheet file", "export", {{"path", fs::absolute(flags_.sheet).string()}});
  file.inputs["material"] = {{sheet.name, "image"}};
  targets_.push_back(file.name);
  graph.nodes.push_back(std::move(sheet));
  graph.nodes.push_back(std::move(file));
}

/// The variation's own comparison, or one of what is resolved with its exemplar.
std::string Sweep::comparison_of(Graph& graph, size_t variation) {
  const auto first_of = [&](const std::string& type) -> const GraphNode* {
    for (const GraphNode& n : graph.nodes)
      if (n.type->name == type &&
          std::ranges::any_of(names_[variation], [&](const auto& name) { return name.second == n.name; }))
        return &n;
    return nullptr;
  };
  if (const GraphNode* own = first_of("compare")) return own->name;
  const GraphNode* resolved = first_of("resolve_uv");
  if (!resolved)
    throw UsageError(
        "--figures and --best need a compare node in the graph, or a resolve_uv whose result can be compared");
  GraphNode figures = memory_node(fmt::format("figures [{}]", variations_[variation].label()), "compare", {});
  figures.inputs["exemplar"] = resolved->inputs.at("material");
  figures.inputs["output"] = {{resolved->name, "material"}};
  figures.inputs["uv"] = resolved->inputs.at("uv");
  graph.nodes.push_back(std::move(figures));
  return graph.nodes.back().name;
}

std::vector<std::string> Sweep::names_of(const std::vector<std::string>& nodes) const {
  std::vector<std::string> out;
  for (const std::string& node : nodes)
    for (const auto& names : names_) {
      const auto at = names.find(node);
      const std::string& name = at == names.end() ? node : at->second;
      if (std::ranges::find(out, name) == out.end()) out.push_back(name);
    }
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
        row[values + f] = shown(figures[i]->figures()[f]);
    table.push_back(std::move(row));
  }
  if (!figures.empty()) answer("{}", aligned(table));
  if (!flags_.figures.empty()) {
    write_whole_file(flags_.figures, as_csv(table));
    say("wrote {}\n", flags_.figures);
  }
  if (is_page(flags_.sheet)) {
    std::vector<Report::Picture> pictures;
    for (size_t i = 0; i < variations_.size(); i++) {
      const Value& picture = result.kept.at(pictures_[i].node).at(pictures_[i].port);
      pictures.push_back({variations_[i].label(), std::get<ImagePtr>(picture)});
    }
    write_report_page(*Report::make("Variations", {}, std::move(pictures)), flags_.sheet);
    say("wrote {}\n", flags_.sheet);
  }
  if (!flags_.best.empty()) tell_best(figures);
}

void Sweep::tell_best(const std::vector<const Report*>& reports) const {
  const auto [name, way] = split_figure(flags_.best);
  std::vector<std::string> known;
  bool higher = way == "max";
  for (const Report::Figure& f : reports.front()->figures()) {
    known.push_back(f.name);
    if (f.name != name || !way.empty()) continue;
    higher = f.help.find("higher is better") != f.help.npos;
    if (!higher && f.help.find("lower is better") == f.help.npos)
      throw UsageError(fmt::format("--best {0}: which way is better? {0}:min or {0}:max", name));
  }
  size_t best = reports.size();
  double value = 0;
  for (size_t i = 0; i < reports.size(); i++) {
    const std::optional<double> here = value_in(*reports[i], name);
    if (!here) continue;
    if (best == reports.size() || (higher ? *here > value : *here < value)) {
      best = i;
      value = *here;
    }
  }
  if (best == reports.size())
    throw UsageError(fmt::format("--best {}: there is no such figure{}", name, suggestion(name, known)));
  answer("best by {}: {} ({})\n", name, variations_[best].label(), value);
}

}  // namespace terrazzo
