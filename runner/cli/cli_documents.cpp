#include <algorithm>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "core/base/text.h"
#include "core/file/atomic_file.h"
#include "graphs/document/draw.h"
#include "graphs/document/migrate.h"
#include "graphs/document/read_document.h"
#include "runner/cli/cli_commands.h"
#include "runner/cli/cli_graph.h"
#include "runner/cli/console.h"
#include "runner/cli/signals.h"
#include "runner/cli/starting_graph.h"
#include "runner/engine/memory_graph.h"
#include "runner/engine/preflight.h"
#include "runner/engine/schedule.h"

namespace terrazzo {

namespace {

namespace fs = std::filesystem;

struct DocumentFlags : GraphFlags {
  std::string out;
};

/// Looks ahead as far as nothing depends on a parameter that is not set.
void check_what_is_set(const Graph& graph, const std::string& unset) {
  std::vector<GraphNode> complete;
  for (const GraphNode& n : graph.nodes)
    if (n.params.size() == n.type->params.size()) complete.push_back(n);
  if (std::vector<Problem> problems = preflight_of_nodes(complete); !problems.empty())
    throw GraphError(graph.file.string(), std::move(problems));
  say("note: nodes that depend on an unset parameter were not checked: --set {}=VALUE\n", unset);
}

int check(const DocumentFlags& flags) {
  const LoadedGraph loaded = flags.load({.allow_unset = true, .look_ahead = preflight_of_nodes});
  for (const std::string& c : loaded.conversions) answer("note: {}\n", c);
  for (const std::string& w : loaded.warnings) say("warning: {}\n", w);
  const auto unset = std::find_if(loaded.parameters.begin(), loaded.parameters.end(),
                                  [](const GraphParameter& p) { return !p.value.has_value(); });
  if (unset == loaded.parameters.end())
    make_plan(loaded.graph, nullptr);
  else
    check_what_is_set(loaded.graph, unset->param.name);
  answer("{} is valid: {}, {}\n", flags.graph, counted(int64_t(loaded.graph.nodes.size()), "node"),
         counted(int64_t(loaded.parameters.size()), "parameter"));
  return exit_done;
}

int upgrade(const DocumentFlags& flags) {
  const std::string before = read_document(flags.graph);
  const std::string after = upgraded(before, flags.graph);
  const std::string& target = flags.out.empty() ? flags.graph : flags.out;
  if (flags.out.empty() && before == after) {
    say("{} is up to date\n", flags.graph);
    return exit_done;
  }
  write_whole_file(target, after);
  say("wrote {}\n", target);
  return exit_done;
}

int draw(const DocumentFlags& flags) {
  const std::string ending = fs::path(flags.out).extension().string();
  if (ending != ".svg" && ending != ".dot")
    throw UsageError(fmt::format("-o takes a file that ends in .svg or .dot; \"{}\" does not", flags.out));
  const Graph graph = flags.load({.allow_unset = true}).graph;
  write_whole_file(flags.out, ending == ".svg" ? draw_svg(graph) : draw_dot(graph));
  say("wrote {}\n", flags.out);
  return exit_done;
}

struct NewFlags {
  std::string folder;
  std::string out;
  bool force = false;
};

/// The folder as a graph file in `beside` should name it.
fs::path seen_from(const fs::path& beside, const fs::path& folder) {
  const fs::path relative =
      fs::absolute(folder).lexically_normal().lexically_relative(fs::absolute(beside).lexically_normal());
  return relative.empty() ? fs::absolute(folder) : relative;
}

RunResult run_on_folder(const Graph& graph, const RunOptions& options, const std::string& folder) {
  try {
    return run_graph(graph, options);
  } catch (const GraphError& e) {
    std::vector<Problem> problems;
    for (const Problem& p : e.problems()) problems.push_back({{}, "FOLDER", for_command_line(p.message, folder)});
    throw GraphError("", std::move(problems));
  }
}

int make_new(const NewFlags& flags) {
  if (!flags.force && fs::exists(flags.out))
    throw UsageError(fmt::format("{} exists; --force overwrites it", flags.out));
  const CancelOnSignal signals;
  Graph graph;
  graph.nodes = {memory_node("exemplar", "load_material", {{"path", fs::absolute(flags.folder).string()}})};
  RunOptions options;
  options.targets.keep = {"exemplar"};
  options.cancelled = &signals.flag();
  const RunResult result = run_on_folder(graph, options, flags.folder);
  for (const Failure& f : result.failures) say("error: {}\n", f.message);
  if (!result.ok()) return result.cancelled ? exit_cancelled : exit_failed;
  const MaterialPtr exemplar = std::get<MaterialPtr>(result.kept.at("exemplar").at("material"));
  const fs::path place = fs::absolute(flags.out).parent_path();
  write_whole_file(flags.out, starting_graph(*exemplar, seen_from(place, flags.folder), result.stages[0].notes));
  say("found {}\nwrote {}\n", exemplar->map_names(), flags.out);
  return exit_done;
}

void add_new_command(CLI::App& app, Chosen& chosen) {
  CLI::App* command = app.add_subcommand("new", "Writes a graph to start from, for the maps found in a folder");
  const auto flags = std::make_shared<NewFlags>();
  command->add_option("FOLDER", flags->folder, "The folder of the exemplar's maps")->required()->type_name("DIR");
  command->add_option("-o,--out", flags->out, "The graph file to write")->required()->type_name("FILE.json");
  command->add_flag("--force", flags->force, "Overwrite the graph file if it exists");
  command->footer("Example:\n  terrazzo new bricks/ -o bricks.json && terrazzo run bricks.json");
  command->callback([&chosen, flags] { chosen = [flags] { return make_new(*flags); }; });
}

}  // namespace

void add_document_commands(CLI::App& app, Chosen& chosen) {
  add_new_command(app, chosen);
  const auto add = [&](const char* name, const char* help, const char* footer, int (*act)(const DocumentFlags&)) {
    CLI::App* command = app.add_subcommand(name, help);
    command->footer(footer);
    const auto flags = std::make_shared<DocumentFlags>();
    add_graph_argument(*command, *flags);
    command->callback([&chosen, flags, act] { chosen = [flags, act] { return act(*flags); }; });
    return std::pair(command, flags);
  };
  const auto [check_command, check_flags] =
      add("check", "Checks a graph file without running it",
          "Reports every mistake at once, with line and column: in the file, in the sources and maps it refers to,\n"
          "and in the paths it would write to.\n"
          "Examples:\n"
          "  terrazzo check bricks.json\n"
          "  terrazzo check bricks.json --set material=bricks/",
          check);
  add_value_flags(*check_command, *check_flags);
  const auto [upgrade_command, upgrade_flags] =
      add("upgrade", "Rewrites a graph file in the current format version and layout",
          "Example:\n  terrazzo upgrade bricks.json", upgrade);
  upgrade_command->add_option("-o,--out", upgrade_flags->out, "Write here and leave the graph file as it is")
      ->type_name("FILE.json");
  const auto [draw_command, draw_flags] = add("draw", "Draws a graph file",
                                              "Examples:\n"
                                              "  terrazzo draw bricks.json -o bricks.svg\n"
                                              "  terrazzo draw bricks.json -o bricks.dot",
                                              draw);
  draw_command->add_option("-o,--out", draw_flags->out, "The drawing")->required()->type_name("FILE.svg|.dot");
  add_value_flags(*draw_command, *draw_flags);
}

}  // namespace terrazzo
