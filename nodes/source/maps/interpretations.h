#pragma once

#include <string>
#include <utility>
#include <vector>

#include "core/material/recognised_map.h"
#include "core/node/node.h"

/// The parameter `interpret` of load_material: what the user says of files, by map, or by "alpha".
namespace terrazzo {

/// A message for each invalid text in `interpret`.
std::vector<std::string> problems_with_interpretations(const Params& params);

/// Takes over what `interpret` says of the maps; "alpha" adds the map that the alpha channel of a file holds, instead
/// of any other. `files`: of the folder. Throws Error about a part of the parameter if there is no such map, or not one
/// file with an alpha channel.
void interpret(const Params& params, const std::vector<MapFile>& files, std::vector<RecognisedMap>& maps);

}  // namespace terrazzo
