#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/material/material.h"

namespace terrazzo {

/// The stock graph for this exemplar, with comments on the maps found and what is worth changing. `folder`: of the
/// maps, as written to the graph; `notes`: of load_material.
std::string starting_graph(const Material& exemplar, const std::filesystem::path& folder,
                           const std::vector<std::string>& notes);

}  // namespace terrazzo
