#pragma once

#include "core/node/node.h"

/// What nodes that analyse an exemplar share.
namespace terrazzo {

/// Parameter "tiles": whether the exemplar tiles.
Param tiles_param();
/// Its value for the material. "auto" compares opposite borders; a note says if they match.
bool exemplar_tiles(NodeContext& node, const Material& material);

/// Port "mask": where the exemplar may be sampled.
Port mask_port();

}  // namespace terrazzo
