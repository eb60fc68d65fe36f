#pragma once

#include <functional>
#include <vector>

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
/// For rules of shapes: throws Error unless the mask at that wire, if there is one, may be one of the material's.
void require_mask_of(const InputForecasts& inputs, const std::string& port, size_t wire, const Forecast& material);
/// What is known of the outputs for such materials, of which all have the same maps; `exemplars_of` makes exemplars of
/// materials, and looks at no pixels of theirs. Throws Error if the atlas would be too large.
using ExemplarsOf = std::function<std::vector<Exemplar>(const std::vector<MaterialPtr>&)>;
OutputForecasts atlas_forecast(const std::vector<Forecast>& materials, int gap, const ExemplarsOf& exemplars_of);
/// The material with its mask, which may be null.
Exemplar masked_exemplar(const MaterialPtr& material, const ImagePtr& mask);

}  // namespace terrazzo
