#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "core/material/material.h"

/// Packed files whose names say nothing.
namespace terrazzo {

/// The maps that such files are looked at for.
inline constexpr std::array packed_semantics = {Semantic::ambient_occlusion, Semantic::roughness, Semantic::metallic};

/// Adds the maps that are probably packed in one of the files `unnamed` (see guess_packing) if the material has none of
/// packed_semantics; takes the file out of `ignored` and tells in `notes` what was guessed. Throws Error if a file
/// cannot be read.
void add_unnamed_packing(const std::filesystem::path& folder, const std::vector<std::string>& unnamed,
                         std::vector<Map>& maps, std::vector<std::string>& ignored, std::vector<std::string>& notes);

}  // namespace terrazzo
