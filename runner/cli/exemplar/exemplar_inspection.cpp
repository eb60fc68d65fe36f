#include "runner/cli/exemplar/exemplar_inspection.h"

#include <filesystem>

#include <fmt/format.h>

#include "core/material/map_names.h"
#include "core/naming/interpretation.h"
#include "runner/cli/cli_commands.h"
#include "runner/plan/memory_graph.h"

namespace terrazzo {

std::map<std::string, std::string> ExemplarFlags::interpretations() const {
  std::map<std::string, std::string> out;
  for (const std::string& text : interpret) {
    const size_t equals = text.find('=');
    const std::string map = text.substr(0, equals);
    const std::optional<Semantic> semantic = semantic_of_map(map);
    if (equals == text.npos || !semantic)
      throw UsageError(fmt::format("--interpret {}: expected MAP=HOW, such as normal=dxt5nm or height=inverted", text));
    const std::string words = text.substr(equals + 1);
    try {
      interpretation_from(words, *semantic);
    } catch (const Error& e) {
      throw UsageError(fmt::format("--interpret {}: {}", text, e.what()));
    }
    std::string& all = out[map];
    all += (all.empty() ? "" : ",") + words;
  }
  return out;
}

void add_exemplar_flags(Command& command, ExemplarFlags& flags) {
  command.add_option("FOLDER", &flags.folder, "The folder of the exemplar's maps").required().takes("DIR");
  command
      .add_option(
          "--name", &flags.name,
          "Which material of a folder with several: the beginning of its files' names; '*' takes all files as one")
      .takes("STEM");
  command
      .add_option("--interpret", &flags.interpret,
                  fmt::format("What a map's file holds if neither its name nor its pixels say so; may be given "
                              "several times. {}",
                              interpretation_help))
      .takes("MAP=HOW")
      .repeated();
}

Graph inspection_graph(const ExemplarFlags& flags) {
  Graph graph;
  graph.nodes = {memory_node("exemplar", "load_material",
                             {{"path", std::filesystem::absolute(flags.folder).string()},
                              {"name", flags.name},
                              {"interpret", flags.interpretations()}}),
                 memory_node("weighted", "weight", {}), memory_node("lattice", "regularity", {}),
                 memory_node("elements", "elements", {})};
  graph.nodes[1].inputs["material"] = {{"exemplar", "material"}};
  graph.nodes[2].inputs["features"] = {{"weighted", "features"}};
  graph.nodes[3].inputs["features"] = {{"lattice", "features"}};
  return graph;
}

}  // namespace terrazzo
