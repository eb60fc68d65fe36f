#pragma once

#include <filesystem>
#include <string>

#include "core/material/material_files.h"
#include "core/node/node.h"

/// The parameter `maps` of the node `load_material`, which assigns files to maps.
namespace terrazzo {

/// "file.png", "file.png:g" for one channel, "file.exr:normal" for a layer, "file.exr:arm.g" for a channel of a layer.
/// <UDIM> is replaced by the tile that the parameter `name` selects. Throws Error if it selects none.
RecognisedMap given_map(const Params& params, const std::string& map, const std::string& text);

/// Throws Error that lists all problems with the files in `maps`: missing files, channels or layers.
void require_given_maps(const Params& params, const std::filesystem::path& folder);

}  // namespace terrazzo
