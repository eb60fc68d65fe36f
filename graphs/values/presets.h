#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "graphs/values/parameters.h"

namespace terrazzo {

/// Values under a name, in the section `presets` of a graph or in the file GRAPH.presets.json beside GRAPH.json:
/// {"worn": {"help": "chipped and dirty", "set": {"seed": 3, "weighted.weights": {"height": 2}}}}
struct Preset {
  std::string name;
  std::string help;
  std::vector<Override> set;
};

/// Reads a section. `where` and `in_graph` as for read_override_object; relative paths lie in `base`.
std::vector<Preset> read_presets(const JsonValue& section, const std::filesystem::path& base, const std::string& where,
                                 bool in_graph, std::vector<Problem>& problems);

/// The presets in the file beside a graph; none if there is no such file.
std::vector<Preset> presets_beside(const std::filesystem::path& graph, std::vector<Problem>& problems);

/// What the presets of these names set, in their order. Unknown names are problems, with the nearest one.
std::vector<Override> chosen_presets(const std::vector<Preset>& presets, const std::vector<std::string>& names,
                                     std::vector<Problem>& problems);

/// Whether there is all that presets set: for those that nobody has chosen.
void check_targets(const std::vector<const Preset*>& presets, const std::vector<GraphParameter>& parameters,
                   const NodeTypes& nodes, std::vector<Problem>& problems);

}  // namespace terrazzo
