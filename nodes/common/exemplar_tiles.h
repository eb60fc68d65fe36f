#pragma once

#include "core/node/node.h"

/// What nodes that analyse an exemplar share.
namespace terrazzo {

/// Parameter "tiles": whether the exemplar tiles.
Param tiles_param();
/// Its answer for the material. "auto" looks at the borders, and a note says so if they fit.
bool exemplar_tiles(NodeContext& node, const Material& material);

/// Port "mask": which part of the exemplar counts.
Port mask_port();

}  // namespace terrazzo
