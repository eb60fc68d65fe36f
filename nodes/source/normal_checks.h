#pragma once

#include <string>
#include <vector>

#include "core/material/material.h"
#include "core/material/material_files.h"

namespace terrazzo {

/// Settles which way green points in the normal maps: `wish` ("auto", "up", "down"), else what `sources` say, else the
/// pixels. Adds to `notes` what was judged, and warnings where the normals do not fit the height map: turned, swapped,
/// flipped.
void settle_normals(const std::string& wish, const std::vector<RecognisedMap>& sources, std::vector<Map>& maps,
                    std::vector<std::string>& notes);

}  // namespace terrazzo
