#include <filesystem>

#include <fmt/format.h>

#include "nodes/sink/export_report.h"
#include "runner/api/session.h"
#include "runner/cli/cli_commands.h"
#include "runner/plan/memory_graph.h"
#include "runner/report/html_report.h"
#include "runner/terminal/console.h"
#include "runner/terminal/limit_flags.h"
#include "runner/terminal/signals.h"
#include "runner/terminal/written_files.h"

namespace terrazzo {

namespace {

namespace fs = std::filesystem;

struct CompareFlags {
  std::string exemplar, output, uv, sheet, tileable = "auto";
  bool json = false, force = false;
  LimitFlags limits{};
};

Graph compare_graph(const CompareFlags& flags) {
  Graph graph;
  GraphNode figures = memory_node("figures", "compare", {{"tileable", flags.tileable}});
  for (const auto& [side, path] : {std::pair("exemplar", flags.exemplar), std::pair("output", flags.output)}) {
    graph.nodes.push_back(reading_node(side, path));
    figures.inputs[side] = {{side, graph.nodes.back().type->outputs.front().name}};
  }
  if (!flags.uv.empty()) {
    GraphNode uv = memory_node("uv", "load_uv", {{"path", fs::absolute(flags.uv).string()}});
    uv.inputs["exemplar"] = figures.inputs.at("exemplar");
    graph.nodes.push_back(std::move(uv));
    figures.inputs["uv"] = {{"uv", "uv"}};
  }
  graph.nodes.push_back(std::move(figures));
  if (!flags.sheet.empty() && !is_page(flags.sheet)) {
    graph.nodes.push_back(memory_node("sheet", "export", {{"path", fs::absolute(flags.sheet).string()}}));
    graph.nodes.back().inputs["material"] = {{"figures", "sheet"}};
  }
  return graph;
}

std::string as_table(const Report& report) {
  size_t names = 0;
  for (const Report::Figure& f : report.figures()) names = std::max(names, f.name.size());
  std::string out = report.title() + "\n";
  for (const Report::Figure& f : report.figures()) {
    const std::string value = std::holds_alternative<double>(f.value) ? fmt::format("{:.4f}", std::get<double>(f.value))
                                                                      : std::get<std::string>(f.value);
    out += fmt::format("  {:<{}}  {:>10}  {}\n", f.name, names, value, f.help);
  }
  return out;
}

int compare(const CompareFlags& flags) {
  flags.limits.apply();
  check_sheet(flags.sheet);
  const CancelOnSignal signals;
  const Graph graph = compare_graph(flags);
  const WrittenFile sheet = {"--sheet", flags.sheet, is_page(flags.sheet) ? WrittenKind::page : WrittenKind::picture};
  check_protected({sheet}, inputs_of(graph));
  check_replaced({sheet}, flags.force);
  const RunResult result =
      Session({.use_cache = false}).run(graph, {.keep = {"figures"}, .cancelled = &signals.flag()});
  for (const Failure& f : result.failures) print_message("error: {}\n", f.message);
  if (result.cancelled) return exit_cancelled;
  if (!result.ok()) return exit_failed;
  const ReportPtr report = std::get<ReportPtr>(result.kept.at("figures").at("report"));
  if (is_page(flags.sheet)) write_report_page(*report, flags.sheet);
  print_result("{}", flags.json ? report_as_json(*report) : as_table(*report));
  return exit_done;
}

}  // namespace

void add_compare_command(Command& program) {
  Command& command = program.add_command("compare", "Scores a result against its exemplar");
  const auto flags = std::make_shared<CompareFlags>();
  command.add_option("EXEMPLAR", &flags->exemplar, "The exemplar: a folder of maps, or one image")
      .required()
      .takes("PATH");
  command.add_option("OUTPUT", &flags->output, "The result: a folder of maps, or one image").required().takes("PATH");
  command
      .add_option("--uv", &flags->uv,
                  "The uv map that was exported with the output: adds figures about seams, copies and evenness of use")
      .takes("FILE");
  command
      .add_option("--tileable", &flags->tileable,
                  "Directions in which the output should wrap around: adds figures about its seams. auto: as the uv "
                  "map does")
      .takes("auto|none|x|y|xy")
      .one_of({"auto", "none", "x", "y", "xy"});
  command.add_flag("--json", &flags->json, "For programs");
  command
      .add_option("--sheet", &flags->sheet,
                  "Also write both side by side: a picture, or a page with the figures if the name ends in .html")
      .takes("FILE");
  command.add_flag("--force", &flags->force, force_help);
  add_limit_flags(command, flags->limits);
  command.footer =
      "Examples:\n"
      "  terrazzo compare bricks/ out/\n"
      "  terrazzo compare bricks/ out/ --sheet comparison.html";
  command.run = [flags] { return compare(*flags); };
}

}  // namespace terrazzo
