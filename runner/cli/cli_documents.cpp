#include <algorithm>
#include <set>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "core/base/text.h"
#include "core/file/atomic_file.h"
#include "graphs/document/draw.h"
#include "graphs/document/grouping.h"
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
  std::string out, name;
  std::vector<std::string> nodes;
  bool check = false;
};

/// Writes a changed graph file to -o, or where it was.
void write_changed(const DocumentFlags& flags, const std::string& text) {
  const std::string& target = flags.out.empty() ? flags.graph : flags.out;
  write_whole_file(target, text);
  say("wrote {}\n", target);
}

/// Looks ahead as far as nothing depends on a parameter, or an input, that is not set.
void check_what_is_set(const Graph& graph) {
  std::vector<GraphNode> complete;
  for (const GraphNode& n : graph.nodes)
    if (n.params.size() == n.type->params.size() && !n.is_open) complete.push_back(n);
  if (std::vector<Problem> problems = preflight_of_nodes(complete); !problems.empty())
    throw GraphError(graph.file.string(), std::move(problems));
}

int check(const DocumentFlags& flags) {
  const LoadedGraph loaded = flags.load({.allow_unset = true, .look_ahead = preflight_of_nodes});
  for (const std::string& c : loaded.conversions) answer("note: {}\n", c);
  for (const std::string& w : loaded.warnings) say("warning: {}\n", w);
  const auto unset = std::find_if(loaded.parameters.begin(), loaded.parameters.end(),
                                  [](const GraphParameter& p) { return !p.value.has_value(); });
  if (unset != loaded.parameters.end()) {
    check_what_is_set(loaded.graph);
    say("note: nodes that depend on an unset parameter were not checked: --set {}=VALUE\n", unset->param.name);
  } else if (!loaded.inputs.empty()) {
    check_what_is_set(loaded.graph);
    say("note: nodes that depend on the graph's inputs were checked only as far as that goes without them\n");
  } else {
    make_plan(loaded.graph, nullptr);
  }
  answer("{} is valid: {}, {}\n", flags.graph, counted(int64_t(loaded.graph.nodes.size()), "node"),
         counted(int64_t(loaded.parameters.size()), "parameter"));
  return exit_done;
}

int upgrade(const DocumentFlags& flags) {
  const std::string before = read_document(flags.graph);
  const std::string after = upgraded(before, flags.graph);
  if (flags.out.empty() && before == after) {
    say("{} is up to date\n", flags.graph);
    return exit_done;
  }
  write_changed(flags, after);
  return exit_done;
}

int format(const DocumentFlags& flags) {
  const std::string before = read_document(flags.graph);
  const std::string after = upgraded(before, flags.graph);
  if (flags.check && before != after) {
    say("{} is not in the canonical layout; terrazzo format {} writes it\n", flags.graph, flags.graph);
    return exit_failed;
  }
  if (before != after || !flags.out.empty()) write_changed(flags, after);
  return exit_done;
}

/// Says where seeds have changed, which come from the graph's and the names of nodes.
void compare_seeds(const DocumentFlags& flags, const std::string& before, const std::string& after) {
  const auto seeds = [&](const std::string& text) {
    std::multiset<int64_t> out;
    const LoadedGraph loaded = load_graph_text(text, flags.graph, {}, {.allow_unset = true});
    for (const GraphNode& n : loaded.graph.nodes)
      if (const auto seed = n.params.find("seed"); seed != n.params.end()) out.insert(std::get<int64_t>(seed->second));
    return out;
  };
  if (seeds(before) != seeds(after))
    say("note: nodes that derive their seeds from the graph's have others now, as they have other names\n");
}

int group(const DocumentFlags& flags) {
  const std::string before = read_document(flags.graph);
  const std::string after = grouped(before, flags.graph, flags.name, flags.nodes);
  compare_seeds(flags, before, after);
  write_changed(flags, after);
  return exit_done;
}

int ungroup(const DocumentFlags& flags) {
  const std::string before = read_document(flags.graph);
  const std::string after = ungrouped(before, flags.graph, flags.name);
  compare_seeds(flags, before, after);
  write_changed(flags, after);
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
  const auto add_out = [](CLI::App* command, DocumentFlags& flags) {
    command->add_option("-o,--out", flags.out, "Write here and leave the graph file as it is")->type_name("FILE.json");
  };
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
  add_out(upgrade_command, *upgrade_flags);
  const auto [format_command, format_flags] =
      add("format", "Rewrites a graph file in the canonical layout; order and comments stay",
          "Examples:\n"
          "  terrazzo format bricks.json\n"
          "  terrazzo format bricks.json --check",
          format);
  add_out(format_command, *format_flags);
  format_command->add_flag("--check", format_flags->check, "Write nothing; exit code 1 if there is something to do");
  const auto [group_command, group_flags] =
      add("group", "Turns nodes of a graph into a subgraph",
          "Their wires, and the graph's parameters that they use, become those of the subgraph.\n"
          "Example:\n  terrazzo group bricks.json export maps picture lit",
          group);
  group_command->add_option("NAME", group_flags->name, "The name of the subgraph, and of the node")->required();
  group_command->add_option("NODE", group_flags->nodes, "The nodes to move into it")->required()->expected(-1);
  add_out(group_command, *group_flags);
  const auto [ungroup_command, ungroup_flags] = add("ungroup", "Turns a subgraph of a graph back into nodes",
                                                    "Example:\n  terrazzo ungroup bricks.json export", ungroup);
  ungroup_command->add_option("NODE", ungroup_flags->name, "The node that is a subgraph")->required();
  add_out(ungroup_command, *ungroup_flags);
  const auto [draw_command, draw_flags] = add("draw", "Draws a graph file",
                                              "Examples:\n"
                                              "  terrazzo draw bricks.json -o bricks.svg\n"
                                              "  terrazzo draw bricks.json -o bricks.dot",
                                              draw);
  draw_command->add_option("-o,--out", draw_flags->out, "The drawing")->required()->type_name("FILE.svg|.dot");
  add_value_flags(*draw_command, *draw_flags);
}

}  // namespace terrazzo
