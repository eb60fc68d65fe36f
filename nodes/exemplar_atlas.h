#pragma once

#include "core/atlas.h"
#include "core/node.h"

/// What nodes that lay several exemplars side by side share.
namespace terrazzo {

/// Ports "material", "mask" and "labels".
std::vector<Port> atlas_outputs();
/// Parameters "gap" and "edges".
std::vector<Param> atlas_params();
/// Sets the outputs from the exemplars, as the parameters say.
void output_atlas(NodeContext& node, const std::vector<Exemplar>& exemplars);
/// A mask of an exemplar that came in at `port`; null if none did. Throws Error unless it has one channel.
ImagePtr exemplar_mask(const std::string& port, const ImagePtr& image);

}  // namespace terrazzo
