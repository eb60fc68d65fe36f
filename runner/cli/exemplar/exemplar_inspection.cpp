#include "runner/cli/exemplar/exemplar_inspection.h"

#include <filesystem>

#include <fmt/format.h>

#include "core/base/suggest.h"
#include "core/material/map_names.h"
#include "core/naming/interpretation.h"
#include "runner/cli/cli_commands.h"
#include "runner/plan/memory_graph.h"

namespace terrazzo {

namespace fs = std::filesystem;

bool ExemplarFlags::is_picture() const {
  std::error_code failure;
  return fs::exists(folder, failure) && !fs::is_directory(folder, failure);
}

std::string ExemplarFlags::folder_of_maps() const {
  return is_picture() ? fs::absolute(folder).parent_path().string() : folder;
}

std::map<std::string, std::string> ExemplarFlags::interpretations() const {
  std::map<std::string, std::string> out;
  for (const std::string& text : interpret) {
    const size_t equals = text.find('=');
    const std::string map = text.substr(0, equals);
    const std::optional<Semantic> semantic = semantic_of_map(map);
    if (equals == text.npos || (!semantic && map != "alpha"))
      throw UsageError(
          fmt::format("--interpret {}: expected MAP=HOW, such as normal=dxt5nm, height=depth or alpha=height{}", text,
                      did_you_mean(map, {semantic_names.begin(), semantic_names.end()})));
    const std::string words = text.substr(equals + 1);
    if (!semantic) {  // the node says what it takes
      out[map] = words;
      continue;
    }
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
  command.add_option("FOLDER", &flags.folder, "The folder of the exemplar's maps; or a single picture, its base colour")
      .required()
      .takes("DIR");
  command
      .add_option(
          "--name", &flags.name,
          "Which material of a folder with several: the beginning of its files' names; '*' takes all files as one")
      .takes("STEM");
  command
      .add_option("--interpret", &flags.interpret,
                  fmt::format("What a map's file holds if neither its name nor its pixels say so; may be given "
                              "several times. {}. alpha=MAP: which map of one value the only file with an alpha "
                              "channel holds there, as in alpha=height",
                              interpretation_help))
      .takes("MAP=HOW")
      .suggests({"normal=xy", "normal=dxt5nm", "normal=as_stored", "height=depth", "height=inverted",
                 "roughness=inverted", "alpha=height", "alpha=opacity"})
      .repeated();
}

void check_picture_flags(const ExemplarFlags& flags) {
  if (!flags.is_picture()) return;
  if (!flags.name.empty())
    throw UsageError(
        fmt::format("--name {}: {} is a picture; name its folder to pick a material there", flags.name, flags.folder));
  for (const auto& [map, how] : flags.interpretations())
    if (map != name_of(Semantic::base_color))
      throw UsageError(
          fmt::format("--interpret {}={}: {} is a picture, which is taken as base_color; name its folder "
                      "for more maps",
                      map, how, flags.folder));
}

Graph inspection_graph(const ExemplarFlags& flags) {
  Graph graph;
  std::map<std::string, std::string> maps;
  std::vector<std::string> ignored;
  if (flags.is_picture()) {
    maps.emplace(name_of(Semantic::base_color), fs::path(flags.folder).filename().string());
    ignored.emplace_back("*");
  }
  graph.nodes = {memory_node("exemplar", "load_material",
                             {{"path", fs::absolute(flags.folder_of_maps()).string()},
                              {"name", flags.name},
                              {"maps", maps},
                              {"ignore", ignored},
                              {"interpret", flags.interpretations()}}),
                 memory_node("weighted", "weight", {}), memory_node("lattice", "regularity", {}),
                 memory_node("elements", "elements", {})};
  graph.nodes[1].inputs["material"] = {{"exemplar", "material"}};
  graph.nodes[2].inputs["features"] = {{"weighted", "features"}};
  graph.nodes[3].inputs["features"] = {{"lattice", "features"}};
  return graph;
}

}  // namespace terrazzo
