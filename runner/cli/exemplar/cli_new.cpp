#include <algorithm>

#include <fmt/format.h>

#include "core/base/suggest.h"
#include "core/file/atomic_file.h"
#include "graphs/text/stock_graphs.h"
#include "runner/cli/cli_commands.h"
#include "runner/cli/cli_graph.h"
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
  std::string like{};  ///< empty: what suits the exemplar
  bool force = false;
  LimitFlags limits{};
};

/// The stock graph to begin with. Throws UsageError.
std::string stock_graph_for(const NewFlags& flags) {
  const bool is_picture = flags.exemplar.is_picture();
  const char* const taken = is_picture ? "a picture" : "a folder of maps";
  if (flags.like.empty()) return std::string(stock_graph_like(flags.exemplar));
  std::vector<std::string> names;
  for (const StockGraph& g : stock_graphs())
    if (takes_an_exemplar(g.text, is_picture))
      names.emplace_back(g.name);
    else if (g.name == flags.like && takes_an_exemplar(g.text, !is_picture))
      throw UsageError(fmt::format("--like {}: it takes {}, and {} is {}", flags.like,
                                   is_picture ? "a folder of maps" : "a picture", flags.exemplar.folder, taken));
  if (std::ranges::find(names, flags.like) == names.end())
    throw UsageError(fmt::format("--like {}: there is no stock graph of that name that takes {}{}", flags.like, taken,
                                 suggestion(flags.like, names)));
  return flags.like;
}

int make_new(const NewFlags& flags) {
  flags.limits.apply();
  if (!flags.force && fs::exists(flags.out))
    throw UsageError(fmt::format("{} exists; --force overwrites it", flags.out));
  check_picture_flags(flags.exemplar);
  const std::string like = stock_graph_for(flags);
  check_protected({{"-o", flags.out, WrittenKind::graph}},
                  files_at(flags.exemplar.folder, "it belongs to the exemplar"));
  check_writable("-o", flags.out);
  const CancelOnSignal signals;
  const NewGraph graph = new_graph(flags.exemplar, flags.out, like, signals.flag());
  if (graph.exit_code != exit_done) return graph.exit_code;
  write_whole_file(flags.out, graph.text);
  for (const std::string& line : graph.findings) print_message("{}\n", line);
  print_message("wrote {}\n", flags.out);
  return exit_done;
}

}  // namespace

void add_new_command(Command& program) {
  Command& command =
      program.add_command("new", "Writes a graph to start from, for the maps found in a folder or for a picture");
  const auto flags = std::make_shared<NewFlags>();
  add_exemplar_flags(command, flags->exemplar);
  command.add_option("-o,--out", &flags->out, "The graph file to write").required().takes("FILE.json");
  command
      .add_option("--like", &flags->like,
                  "The stock graph (graphs/NAME.json) to begin with; material if not given, texture for a picture")
      .takes("NAME")
      .suggests(stock_names());
  add_limit_flags(command, flags->limits);
  command.add_flag("--force", &flags->force, "Overwrite the graph file if it exists");
  command.footer =
      "It inspects the maps, weights them, looks for repeats, and explains its choices in comments.\n"
      "Examples:\n"
      "  terrazzo new bricks/ -o bricks.json && terrazzo run bricks.json\n"
      "  terrazzo new bricks/ -o tiling.json --like make_tileable\n"
      "  terrazzo new photo.jpg -o photo.json";
  command.run = [flags] { return make_new(*flags); };
}

}  // namespace terrazzo
