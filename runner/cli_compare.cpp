#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "runner/cli_commands.h"
#include "runner/memory_graph.h"
#include "runner/say.h"
#include "runner/schedule.h"
#include "runner/signals.h"

namespace terrazzo {

namespace {

struct CompareFlags {
  std::string exemplar, output;
  bool json = false;
};

Graph compare_graph(const CompareFlags& flags) {
  Graph graph;
  graph.nodes = {reading_node("exemplar", flags.exemplar), reading_node("output", flags.output),
                 memory_node("figures", "compare", {})};
  for (const char* side : {"exemplar", "output"}) {
    const Port& first = graph.find(side)->type->outputs.front();
    graph.nodes.back().inputs[side] = {{side, first.name}};
  }
  return graph;
}

std::string as_json(const Report& report) {
  using Json = nlohmann::ordered_json;
  Json figures = Json::array();
  for (const Report::Figure& f : report.figures()) {
    const Json value = std::visit([](const auto& v) { return Json(v); }, f.value);
    figures.push_back({{"name", f.name}, {"value", value}, {"help", f.help}});
  }
  return Json({{"title", report.title()}, {"figures", std::move(figures)}})
             .dump(2, ' ', false, Json::error_handler_t::replace) +
         "\n";
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
  const CancelOnSignal signals;
  const Graph graph = compare_graph(flags);
  RunOptions options;
  options.targets.keep = {"figures"};
  options.cancelled = &signals.flag();
  const RunResult result = run_graph(graph, options);
  for (const Failure& f : result.failures) say("error: {}\n", f.message);
  if (result.cancelled) return exit_cancelled;
  if (!result.ok()) return exit_failed;
  const ReportPtr report = std::get<ReportPtr>(result.kept.at("figures").at("report"));
  fmt::print("{}", flags.json ? as_json(*report) : as_table(*report));
  return exit_done;
}

}  // namespace

void add_compare_command(CLI::App& app, Chosen& chosen) {
  CLI::App* command = app.add_subcommand("compare", "Scores a result against its exemplar");
  const auto flags = std::make_shared<CompareFlags>();
  command->add_option("EXEMPLAR", flags->exemplar, "A folder of maps, or one image")->required()->type_name("PATH");
  command->add_option("OUTPUT", flags->output, "What was made from it")->required()->type_name("PATH");
  command->add_flag("--json", flags->json, "For programs");
  command->footer("Example:\n  terrazzo compare bricks/ out/");
  command->callback([&chosen, flags] { chosen = [flags] { return compare(*flags); }; });
}

}  // namespace terrazzo
