#include <fstream>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <unistd.h>

#include "graphs/document/draw.h"
#include "graphs/document/load.h"
#include "graphs/document/migrate.h"
#include "runner/cli_commands.h"

namespace terrazzo {

namespace {

namespace fs = std::filesystem;

struct DocumentFlags {
  std::string graph;
  std::string out;
  std::vector<std::string> set;
};

/// All of the text or nothing: written beside the target and renamed.
void write_whole(const fs::path& path, const std::string& text) {
  const fs::path temporary = path.string() + fmt::format(".{}", ::getpid());
  std::ofstream out(temporary, std::ios::binary);
  out << text;
  out.close();
  std::error_code failure;
  if (out) fs::rename(temporary, path, failure);
  if (out && !failure) return;
  fs::remove(temporary, failure);
  throw Error(fmt::format("cannot write {}", path.string()));
}

int check(const DocumentFlags& flags) {
  const LoadedGraph loaded = load_graph(flags.graph, flags.set, {.allow_unset = true});
  for (const std::string& c : loaded.conversions) fmt::print("{}\n", c);
  for (const std::string& w : loaded.warnings) fmt::print(stderr, "warning: {}\n", w);
  const auto counted = [](size_t n, const char* what) { return fmt::format("{} {}{}", n, what, n == 1 ? "" : "s"); };
  fmt::print("{} is valid: {}, {}\n", flags.graph, counted(loaded.graph.nodes.size(), "node"),
             counted(loaded.parameters.size(), "parameter"));
  return exit_done;
}

int upgrade(const DocumentFlags& flags) {
  const std::string before = read_document(flags.graph);
  const std::string after = upgraded(before, flags.graph);
  const std::string& target = flags.out.empty() ? flags.graph : flags.out;
  if (flags.out.empty() && before == after) {
    fmt::print(stderr, "{} is up to date\n", flags.graph);
    return exit_done;
  }
  write_whole(target, after);
  fmt::print(stderr, "wrote {}\n", target);
  return exit_done;
}

int draw(const DocumentFlags& flags) {
  const std::string ending = fs::path(flags.out).extension().string();
  if (ending != ".svg" && ending != ".dot")
    throw UsageError(fmt::format("-o takes a file that ends in .svg or .dot; \"{}\" does not", flags.out));
  const Graph graph = load_graph(flags.graph, flags.set, {.allow_unset = true}).graph;
  write_whole(flags.out, ending == ".svg" ? draw_svg(graph) : draw_dot(graph));
  fmt::print(stderr, "wrote {}\n", flags.out);
  return exit_done;
}

}  // namespace

void add_document_commands(CLI::App& app, Chosen& chosen) {
  const auto add = [&](const char* name, const char* help, int (*act)(const DocumentFlags&)) {
    CLI::App* command = app.add_subcommand(name, help);
    const auto flags = std::make_shared<DocumentFlags>();
    command->add_option("GRAPH", flags->graph, "The graph file")->required()->type_name("FILE.json");
    command->callback([&chosen, flags, act] { chosen = [flags, act] { return act(*flags); }; });
    return std::pair(command, flags);
  };
  const auto add_set = [](CLI::App* command, DocumentFlags& flags) {
    command->add_option("--set", flags.set, "Sets a graph parameter, or node.parameter")
        ->type_name("NAME=VALUE")
        ->take_all()
        ->expected(1);
  };
  const auto [check_command, check_flags] = add("check", "Checks a graph file without running it", check);
  add_set(check_command, *check_flags);
  const auto [upgrade_command, upgrade_flags] =
      add("upgrade", "Rewrites a graph file in the current format version and layout", upgrade);
  upgrade_command->add_option("-o,--out", upgrade_flags->out, "Write here and leave the graph file as it is")
      ->type_name("FILE.json");
  const auto [draw_command, draw_flags] = add("draw", "Draws a graph file", draw);
  draw_command->add_option("-o,--out", draw_flags->out, "The drawing")->required()->type_name("FILE.svg|.dot");
  add_set(draw_command, *draw_flags);
}

}  // namespace terrazzo
