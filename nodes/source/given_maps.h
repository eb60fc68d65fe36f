#pragma once

#include <filesystem>
#include <string>

#include "core/material/material_files.h"
#include "core/node/node.h"

/// The parameter `maps` of the node `load_material`: which file holds which map.
namespace terrazzo {

/// "file.png", "file.png:g" for one channel, "file.exr:normal" for a layer, "file.exr:arm.g" for a channel of a layer.
/// <UDIM> stands for the tile that the parameter `name` picks. Throws Error if it picks none.
RecognisedMap given_map(const Params& params, const std::string& map, const std::string& text);

/// Throws Error with all that is wrong with the files that `maps` gives: not in the folder, or without the channels or
/// the layer.
void require_given_maps(const Params& params, const std::filesystem::path& folder);

}  // namespace terrazzo
