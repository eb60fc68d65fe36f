#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/material/material.h"

/// What sites put beside the maps that they offer. Thread-safe; a file that cannot be read says nothing.
namespace terrazzo {

/// The JSON files of the folder, sorted, without terrazzo's own.
std::vector<std::filesystem::path> site_documents(const std::filesystem::path& folder);

/// The size that one of them says the surface has. Quixel Megascans: "physicalSize", or "scanArea" among "meta", in
/// metres ("2x2", "2x2 m"). Adds to `notes` who says it. Not known if none does.
PhysicalSize metres_in_documents(const std::filesystem::path& folder, std::vector<std::string>& notes);

}  // namespace terrazzo
