#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/material/material.h"

/// Metadata files that download sites put beside maps. Thread-safe. Ignores unreadable files.
namespace terrazzo {

/// The JSON files of the folder, sorted, without terrazzo's own.
std::vector<std::filesystem::path> site_documents(const std::filesystem::path& folder);

/// The physical size stated in one of them. Quixel Megascans: "physicalSize", or "scanArea" in "meta", in metres
/// ("2x2", "2x2 m"). Adds a note on the source. Unknown if none states it.
PhysicalSize metres_in_documents(const std::filesystem::path& folder, std::vector<std::string>& notes);

}  // namespace terrazzo
