#pragma once

#include <functional>
#include <vector>

#include "core/material/atlas.h"
#include "core/node/node.h"

/// Helpers for nodes that pack several exemplars side by side.
namespace terrazzo {

/// Ports "material", "mask" and "labels".
std::vector<Port> atlas_outputs();
/// Parameters "gap" and "edges".
std::vector<Param> atlas_params();
/// Sets the outputs from the exemplars and parameters. If the atlas is large, a note recommends `how_to_shrink` ("fewer
/// exemplars").
void output_atlas(NodeContext& node, const std::vector<Exemplar>& exemplars, const std::string& how_to_shrink);
/// For NodeType::infer: throws Error if the mask at this wire, if there is one, is known not to fit the material.
void require_mask_of(const InputForecasts& inputs, const std::string& port, size_t wire, const Forecast& material);
/// The forecast of the outputs for these materials, which all have the same maps. `exemplars_of` makes exemplars from
/// materials and must not read pixels. Throws Error if the atlas would be too large.
using ExemplarsOf = std::function<std::vector<Exemplar>(const std::vector<MaterialPtr>&)>;
OutputForecasts atlas_forecast(const std::vector<Forecast>& materials, int gap, const ExemplarsOf& exemplars_of);
/// The exemplar of a material and its mask, which may be null.
Exemplar masked_exemplar(const MaterialPtr& material, const ImagePtr& mask);

}  // namespace terrazzo
