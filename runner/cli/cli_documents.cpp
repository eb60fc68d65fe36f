#include <algorithm>
#include <functional>
#include <set>

#include <fmt/format.h>

#include "core/base/text.h"
#include "core/file/atomic_file.h"
#include "graphs/text/migrate.h"
#include "graphs/text/read_document.h"
#include "graphs/text/stock_graphs.h"
#include "graphs/tools/diff.h"
#include "graphs/tools/draw.h"
#include "graphs/tools/grouping.h"
#include "graphs/tools/pack.h"
#include "runner/cli/cli_commands.h"
#include "runner/cli/cli_graph.h"
#include "runner/terminal/console.h"
#include "runner/terminal/written_files.h"

namespace terrazzo {

namespace {

namespace fs = std::filesystem;

struct DocumentFlags : GraphFlags {
  std::string out, name, to;
  std::vector<std::string> nodes;
  bool check = false, force = false;
};

/// Throws UsageError unless -o names a file that a graph may be written to.
void check_out(const DocumentFlags& flags, WrittenKind kind) {
  check_protected({{"-o", flags.out, kind}}, flags.files());
  check_replaced({{"-o", flags.out, kind}}, flags.force);
}

/// Writes a changed graph file to -o, or in place.
void write_changed(const DocumentFlags& flags, const std::string& text) {
  const std::string& target = flags.out.empty() ? flags.graph : flags.out;
  if (is_stock(target))
    throw UsageError(fmt::format("{} is part of the program; -o FILE.json names a file to write", target));
  write_whole_file(target, text);
  print_message("wrote {}\n", target);
}

int upgrade(const DocumentFlags& flags) {
  check_out(flags, WrittenKind::graph);
  const std::string before = read_document(flags.graph);
  const std::string after = upgraded(before, flags.graph);
  if (flags.out.empty() && before == after) {
    print_message("{} is up to date\n", flags.graph);
    return exit_done;
  }
  write_changed(flags, after);
  return exit_done;
}

int format(const DocumentFlags& flags) {
  check_out(flags, WrittenKind::graph);
  const std::string before = read_document(flags.graph);
  const std::string after = upgraded(before, flags.graph);
  if (flags.check && before != after) {
    print_message("{} is not in the canonical layout; terrazzo format {} writes it\n", flags.graph, flags.graph);
    return exit_failed;
  }
  if (before != after || !flags.out.empty()) write_changed(flags, after);
  return exit_done;
}

/// Reports changed seeds, which are derived from the graph's seed and the nodes' names.
void compare_seeds(const DocumentFlags& flags, const std::string& before, const std::string& after) {
  const auto seeds = [&](const std::string& text) {
    std::multiset<int64_t> out;
    const LoadedGraph loaded = load_graph_text(text, flags.graph, {}, {.allow_unset = true});
    for (const GraphNode& n : loaded.graph.nodes)
      if (const auto seed = n.params.find("seed"); seed != n.params.end()) out.insert(std::get<int64_t>(seed->second));
    return out;
  };
  if (seeds(before) != seeds(after))
    print_message("note: nodes that derive their seeds from the graph's have others now, as they have other names\n");
}

int regroup(const DocumentFlags& flags, const std::function<std::string(const std::string&)>& rewrite) {
  check_out(flags, WrittenKind::graph);
  const std::string before = read_document(flags.graph), after = as_usage([&] { return rewrite(before); });
  compare_seeds(flags, before, after);
  write_changed(flags, after);
  return exit_done;
}

/// Writes the new graph to its own file, for use by other graphs.
int group_to_file(const DocumentFlags& flags) {
  check_out(flags, WrittenKind::graph);
  if (fs::exists(flags.to)) throw UsageError(fmt::format("--to {}: the file exists; name another", flags.to));
  if (!flags.to.ends_with(".json"))
    throw UsageError(fmt::format("--to {}: expected a name that ends in .json", flags.to));
  const fs::path folder = fs::absolute(flags.out.empty() ? flags.graph : flags.out).lexically_normal().parent_path();
  const fs::path type = fs::absolute(flags.to).lexically_normal().lexically_relative(folder);
  const std::string before = read_document(flags.graph);
  const std::string grouped_text = as_usage([&] { return grouped(before, flags.graph, flags.name, flags.nodes); });
  const GraphInFile moved = moved_to_file(grouped_text, flags.graph, flags.name, type.generic_string());
  write_whole_file(flags.to, moved.graph);
  print_message("wrote {}\n", flags.to);
  write_changed(flags, moved.document);
  compare_seeds(flags, before, moved.document);
  return exit_done;
}

int group(const DocumentFlags& flags) {
  if (!flags.to.empty()) return group_to_file(flags);
  return regroup(flags, [&](const std::string& text) { return grouped(text, flags.graph, flags.name, flags.nodes); });
}

int ungroup(const DocumentFlags& flags) {
  return regroup(flags, [&](const std::string& text) { return ungrouped(text, flags.graph, flags.name); });
}

int diff(const DocumentFlags& flags) {
  const std::vector<std::string> found = differences(current_document(read_document(flags.graph), flags.graph),
                                                     current_document(read_document(flags.name), flags.name));
  for (const std::string& line : found) print_result("{}\n", line);
  if (found.empty()) print_message("the graphs do not differ\n");
  return found.empty() ? exit_done : exit_failed;
}

int pack(const DocumentFlags& flags) {
  LoadOptions options;
  options.presets = flags.presets;
  options.settings.assign(flags.settings.begin(), flags.settings.end());
  check_out(flags, WrittenKind::pack);
  const std::vector<Override> set = overrides_from(flags.set);
  check_protected({{"-o", flags.out, WrittenKind::pack}}, inputs_of(load_graph(flags.graph, set, options).graph));
  const PackedFiles packed = write_pack(flags.graph, set, options, flags.out);
  for (const std::string& renamed : packed.renamed) print_message("note: {}\n", renamed);
  for (const std::string& file : packed.left_out)
    print_message("warning: {} is not in the pack: no parameter of a node names it\n", file);
  print_message("wrote {}: the graph and {}, {}\n", flags.out, counted(int64_t(packed.count), "file"),
                shown_bytes(packed.bytes));
  return exit_done;
}

int draw(const DocumentFlags& flags) {
  const std::string ending = fs::path(flags.out).extension().string();
  if (ending != ".svg" && ending != ".dot")
    throw UsageError(fmt::format("-o takes a file that ends in .svg or .dot; \"{}\" does not", flags.out));
  check_out(flags, WrittenKind::drawing);
  GraphFlags opened = flags;
  opened.open_pack();
  const Graph graph = opened.load({.allow_unset = true}).graph;
  check_protected({{"-o", flags.out, WrittenKind::drawing}}, inputs_of(graph));
  write_whole_file(flags.out, ending == ".svg" ? draw_svg(graph) : draw_dot(graph));
  print_message("wrote {}\n", flags.out);
  return exit_done;
}

}  // namespace

void add_document_commands(Command& program) {
  const auto add_out = [](Command& command, DocumentFlags& flags) {
    command.add_option("-o,--out", &flags.out, "Write to this file and leave the graph file unchanged")
        .takes("FILE.json");
    command.add_flag("--force", &flags.force, force_help);
  };
  const auto add = [&](const char* name, const char* help, const char* footer, int (*act)(const DocumentFlags&)) {
    Command& command = program.add_command(name, help);
    command.footer = footer;
    const auto flags = std::make_shared<DocumentFlags>();
    add_graph_argument(command, *flags);
    command.run = [flags, act] { return act(*flags); };
    return std::pair(&command, flags);
  };
  const auto [upgrade_command, upgrade_flags] =
      add("upgrade", "Rewrites a graph file in the current format version and layout",
          "Example:\n  terrazzo upgrade bricks.json", upgrade);
  add_out(*upgrade_command, *upgrade_flags);
  const auto [format_command, format_flags] =
      add("format", "Rewrites a graph file in the canonical layout; order and comments stay",
          "Examples:\n"
          "  terrazzo format bricks.json\n"
          "  terrazzo format bricks.json --check",
          format);
  add_out(*format_command, *format_flags);
  format_command->add_flag("--check", &format_flags->check, "Write nothing; exit code 1 if there is something to do");
  const auto [group_command, group_flags] =
      add("group", "Turns nodes of a graph into a subgraph",
          "Their wires, and the graph's parameters that they use, become those of the subgraph.\n"
          "Examples:\n  terrazzo group bricks.json export maps picture lit\n"
          "  terrazzo group bricks.json save files --to parts/save.json",
          group);
  group_command->add_option("NAME", &group_flags->name, "The name of the subgraph, and of the node").required();
  group_command->add_option("NODE", &group_flags->nodes, "The nodes to move into it").required();
  group_command
      ->add_option("--to", &group_flags->to,
                   "Write the subgraph to its own file, which other graphs use as \"type\": \"FILE.json\"")
      .takes("FILE.json");
  add_out(*group_command, *group_flags);
  const auto [ungroup_command, ungroup_flags] = add("ungroup", "Turns a subgraph of a graph back into nodes",
                                                    "Example:\n  terrazzo ungroup bricks.json export", ungroup);
  ungroup_command->add_option("NODE", &ungroup_flags->name, "The node that is a subgraph").required();
  add_out(*ungroup_command, *ungroup_flags);
  const auto [diff_command, diff_flags] =
      add("diff", "Describes how two graph files differ",
          "Order, layout and comments do not count. Exit code 0 if nothing differs, 1 if something does.\n"
          "Example:\n  terrazzo diff bricks.json bricks-new.json",
          diff);
  diff_command->add_option("OTHER", &diff_flags->name, "The graph file to compare with").required().takes("FILE.json");
  const auto [pack_command, pack_flags] =
      add("pack", "Writes a graph with all that it reads as one file, which runs elsewhere",
          "run, check, draw and submit take a pack like a graph file. It is a tar archive.\n"
          "Example:\n"
          "  terrazzo pack wall.json --set material=bricks/ -o wall.tzpack && terrazzo run wall.tzpack --set out=there",
          pack);
  pack_command->add_option("-o,--out", &pack_flags->out, "The file to write").required().takes("FILE.tzpack");
  pack_command->add_flag("--force", &pack_flags->force, force_help);
  add_value_flags(*pack_command, *pack_flags);
  const auto [draw_command, draw_flags] = add("draw", "Draws a graph file",
                                              "Examples:\n"
                                              "  terrazzo draw bricks.json -o bricks.svg\n"
                                              "  terrazzo draw bricks.json -o bricks.dot",
                                              draw);
  draw_command->add_option("-o,--out", &draw_flags->out, "The drawing").required().takes("FILE.svg|.dot");
  draw_command->add_flag("--force", &draw_flags->force, force_help);
  add_value_flags(*draw_command, *draw_flags);
}

}  // namespace terrazzo
