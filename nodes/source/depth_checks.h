#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/material/material.h"
#include "core/material/material_files.h"

/// Maps called "depth": of some programs near is bright, as in a height map, of others near is dark.
namespace terrazzo {

/// Whether a file's name, or its layer's, says depth.
bool is_depth(const std::string& file, const std::string& layer);

/// How to turn such a map round if need be, for a note.
std::string note_on_depth(const std::string& place, const std::string& map);

/// Inverts heights that are called depth where the normals or the occlusion of the material tell that near is dark, and
/// adds to `notes` what was judged, or how to say it. `normal_y`: which way green points, if the user says it.
void settle_depths(std::optional<NormalY> normal_y, const std::vector<RecognisedMap>& sources, std::vector<Map>& maps,
                   std::vector<std::string>& notes);

}  // namespace terrazzo
