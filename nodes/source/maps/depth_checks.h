#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/material/material.h"
#include "core/material/material_files.h"

/// Maps named "depth": in some programs near is bright, as in a height map, in others near is dark.
namespace terrazzo {

/// Whether the name of a file or layer contains "depth".
bool is_depth(const std::string& file, const std::string& layer);

/// A note on how to invert such a map if necessary.
std::string note_on_depth(const std::string& place, const std::string& map);

/// Inverts heights named "depth" if the material's normals or occlusion show that near is dark. Adds notes on the
/// decision, or on how to set it. `normal_y`: the convention set by the user, if any.
void settle_depths(std::optional<NormalY> normal_y, const std::vector<RecognisedMap>& sources, std::vector<Map>& maps,
                   std::vector<std::string>& notes);

}  // namespace terrazzo
