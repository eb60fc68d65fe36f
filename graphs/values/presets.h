#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "graphs/values/parameters.h"

namespace terrazzo {

/// A named set of values, in the section `presets` of a graph or in the file GRAPH.presets.json beside GRAPH.json:
/// {"worn": {"help": "chipped and dirty", "set": {"seed": 3, "weighted.weights": {"height": 2}}}}
struct Preset {
  std::string name;
  std::string help;
  std::vector<Override> set;
};

/// Reads a section. `where` and `in_graph` as for read_override_object; relative paths start at `base`.
std::vector<Preset> read_presets(const JsonValue& section, const std::filesystem::path& base, const std::string& where,
                                 bool in_graph, std::vector<Problem>& problems);

/// The presets in the file beside a graph; empty if there is no such file.
std::vector<Preset> presets_beside(const std::filesystem::path& graph, std::vector<Problem>& problems);

/// The overrides of the named presets, in order. Unknown names become problems with a suggestion.
std::vector<Override> chosen_presets(const std::vector<Preset>& presets, const std::vector<std::string>& names,
                                     std::vector<Problem>& problems);

/// Checks that the targets of unused presets exist.
void check_targets(const std::vector<const Preset*>& presets, const std::vector<GraphParameter>& parameters,
                   const NodeTypes& nodes, std::vector<Problem>& problems);

}  // namespace terrazzo
