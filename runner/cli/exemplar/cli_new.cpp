#include <algorithm>

#include <fmt/format.h>

#include "core/base/suggest.h"
#include "core/exemplar/features.h"
#include "core/file/atomic_file.h"
#include "graphs/text/problem.h"
#include "graphs/text/stock_graphs.h"
#include "runner/api/session.h"
#include "runner/cli/cli_commands.h"
#include "runner/cli/cli_run.h"
#include "runner/cli/exemplar/exemplar_inspection.h"
#include "runner/cli/exemplar/starting_graph.h"
#include "runner/terminal/console.h"
#include "runner/terminal/limit_flags.h"
#include "runner/terminal/signals.h"
#include "runner/terminal/written_files.h"

namespace terrazzo {

namespace {

namespace fs = std::filesystem;

struct NewFlags {
  ExemplarFlags exemplar;
  std::string out;
  std::string like = "material";
  bool force = false;
  LimitFlags limits{};
};

/// The folder's path for a graph file in `beside`.
fs::path seen_from(const fs::path& beside, const fs::path& folder) {
  const fs::path relative =
      fs::absolute(folder).lexically_normal().lexically_relative(fs::absolute(beside).lexically_normal());
  return relative.empty() ? fs::absolute(folder) : relative;
}

RunResult run_on_folder(const Graph& graph, const RunRequest& request, const std::string& folder) {
  try {
    return Session({.use_cache = false}).run(graph, request);
  } catch (const GraphError& e) {
    std::vector<Problem> problems;
    for (const Problem& p : e.problems()) problems.push_back({{}, "FOLDER", for_command_line(p.message, folder)});
    throw GraphError("", std::move(problems));
  }
}

void require_stock_graph(const NewFlags& flags) {
  std::vector<std::string> names;
  for (const StockGraph& g : stock_graphs())
    if (takes_a_folder(g.text)) names.emplace_back(g.name);
  if (std::ranges::find(names, flags.like) == names.end())
    throw UsageError(fmt::format("--like {}: there is no stock graph of that name that takes a folder of maps{}",
                                 flags.like, suggestion(flags.like, names)));
}

int make_new(const NewFlags& flags) {
  flags.limits.apply();
  if (!flags.force && fs::exists(flags.out))
    throw UsageError(fmt::format("{} exists; --force overwrites it", flags.out));
  require_stock_graph(flags);
  check_protected({{"-o", flags.out, WrittenKind::graph}},
                  files_at(flags.exemplar.folder, "it belongs to the exemplar"));
  check_writable("-o", flags.out);
  const CancelOnSignal signals;
  const Graph graph = inspection_graph(flags.exemplar);
  const RunResult result =
      run_on_folder(graph, {.keep = {"exemplar", "elements"}, .cancelled = &signals.flag()}, flags.exemplar.folder);
  for (const Failure& f : result.failures) print_message("error: {}\n", f.message);
  print_warnings(result);
  if (!result.ok()) return result.cancelled ? exit_cancelled : exit_failed;
  const auto features = std::get<FeaturesPtr>(result.kept.at("elements").at("features"));
  ExemplarFindings look{.exemplar = std::get<MaterialPtr>(result.kept.at("exemplar").at("material")),
                        .folder = seen_from(fs::absolute(flags.out).parent_path(), flags.exemplar.folder),
                        .name = flags.exemplar.name,
                        .interpret = flags.exemplar.interpretations(),
                        .notes = result.stages[0].notes,
                        .lattice_notes = result.stages[2].notes,
                        .repeats = features->repeats().lattice.rank > 0,
                        .streaks = features->repeats().streaks.any(),
                        .tiles = features->wraps(),
                        .method = suitable_method(*features, Task())};
  write_whole_file(flags.out, starting_graph(look, stock_graph(flags.like)));
  print_message("found {}\n{}\n{}\nwrote {}\n", look.exemplar->map_names(), look.nature(), look.advice(), flags.out);
  return exit_done;
}

}  // namespace

void add_new_command(Command& program) {
  Command& command = program.add_command("new", "Writes a graph to start from, for the maps found in a folder");
  const auto flags = std::make_shared<NewFlags>();
  add_exemplar_flags(command, flags->exemplar);
  command.add_option("-o,--out", &flags->out, "The graph file to write").required().takes("FILE.json");
  command.add_option("--like", &flags->like, "The stock graph (graphs/NAME.json) to begin with; material if not given")
      .takes("NAME");
  add_limit_flags(command, flags->limits);
  command.add_flag("--force", &flags->force, "Overwrite the graph file if it exists");
  command.footer =
      "It inspects the maps, weights them, looks for repeats, and explains its choices in comments.\n"
      "Examples:\n"
      "  terrazzo new bricks/ -o bricks.json && terrazzo run bricks.json\n"
      "  terrazzo new bricks/ -o tiling.json --like make_tileable";
  command.run = [flags] { return make_new(*flags); };
}

}  // namespace terrazzo
