#pragma once

#include <string>
#include <vector>

#include "core/material/material.h"
#include "core/material/material_files.h"

namespace terrazzo {

/// Determines the convention of the normal maps: from `wish` ("auto", "up", "down"), else from `sources`, else from the
/// pixels. Adds notes on the decision, and warnings if the normals do not fit the height map because they are rotated,
/// swapped or flipped.
void settle_normals(const std::string& wish, const std::vector<RecognisedMap>& sources, std::vector<Map>& maps,
                    std::vector<std::string>& notes);

}  // namespace terrazzo
