#include <algorithm>

#include <fmt/format.h>

#include "core/base/suggest.h"
#include "core/file/atomic_file.h"
#include "graphs/text/stock_graphs.h"
#include "runner/cli/cli_commands.h"
#include "runner/cli/exemplar/new_graph.h"
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
  const NewGraph graph = new_graph(flags.exemplar, flags.out, flags.like, signals.flag());
  if (graph.exit_code != exit_done) return graph.exit_code;
  write_whole_file(flags.out, graph.text);
  for (const std::string& line : graph.findings) print_message("{}\n", line);
  print_message("wrote {}\n", flags.out);
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
