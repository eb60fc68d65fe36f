#pragma once

#include "core/node/node.h"

/// Helpers for nodes that analyse an exemplar.
namespace terrazzo {

/// Parameter "tiles": whether the exemplar tiles.
Param tiles_param();
/// The parameter's value for the material. "auto" compares opposite borders and adds a note if they match.
bool exemplar_tiles(NodeContext& node, const Material& material);

/// Port "mask": where the exemplar may be sampled.
Port mask_port();

}  // namespace terrazzo
