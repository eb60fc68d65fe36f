#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "core/material/material.h"

/// Packed files without map keywords in their names.
namespace terrazzo {

/// The maps that such files may contain.
inline constexpr std::array packed_semantics = {Semantic::ambient_occlusion, Semantic::roughness, Semantic::metallic};

/// If the material has none of packed_semantics, adds the maps that are probably packed in one of the files `unnamed`
/// (see guess_packing), removes the file from `ignored`, and adds a note. Throws Error if a file cannot be read.
void add_unnamed_packing(const std::filesystem::path& folder, const std::vector<std::string>& unnamed,
                         std::vector<Map>& maps, std::vector<std::string>& ignored, std::vector<std::string>& notes);

}  // namespace terrazzo
