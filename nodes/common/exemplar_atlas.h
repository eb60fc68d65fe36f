#pragma once

#include "core/material/atlas.h"
#include "core/node/node.h"

/// What nodes that lay several exemplars side by side share.
namespace terrazzo {

/// Ports "material", "mask" and "labels".
std::vector<Port> atlas_outputs();
/// Parameters "gap" and "edges".
std::vector<Param> atlas_params();
/// Sets the outputs from the exemplars and parameters. If the atlas is large, a note recommends `how_to_shrink` ("fewer
/// exemplars").
void output_atlas(NodeContext& node, const std::vector<Exemplar>& exemplars, const std::string& how_to_shrink);
/// The material with the mask of `port`, or null. Throws Error unless the mask has one channel and the material's
/// aspect ratio.
Exemplar masked_exemplar(const MaterialPtr& material, const std::string& port, const ImagePtr& mask);

}  // namespace terrazzo
