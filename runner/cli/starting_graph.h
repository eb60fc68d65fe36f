#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/material/material.h"

namespace terrazzo {

/// The text of a graph to start from: the stock graph for this exemplar, with comments on what was found and what is
/// worth changing. `folder` is where the maps lie, as the graph file should say it; `notes` are load_material's.
std::string starting_graph(const Material& exemplar, const std::filesystem::path& folder,
                           const std::vector<std::string>& notes);

}  // namespace terrazzo
