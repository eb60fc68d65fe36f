#pragma once

#include "core/material/atlas.h"
#include "core/node/node.h"

/// What nodes that lay several exemplars side by side share.
namespace terrazzo {

/// Ports "material", "mask" and "labels".
std::vector<Port> atlas_outputs();
/// Parameters "gap" and "edges".
std::vector<Param> atlas_params();
/// Sets the outputs from the exemplars, as the parameters say. If the atlas is so large that analysis takes long, the
/// note tells `how_to_shrink` it, what there should be less of.
void output_atlas(NodeContext& node, const std::vector<Exemplar>& exemplars, const std::string& how_to_shrink);
/// The material with a mask that came in at `port`, if one did. Throws Error unless it has the material's shape and one
/// channel.
Exemplar masked_exemplar(const MaterialPtr& material, const std::string& port, const ImagePtr& mask);

}  // namespace terrazzo
