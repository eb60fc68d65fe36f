#pragma once

#include "core/image/occlusion.h"
#include "nodes/common/node_helpers.h"

/// What nodes share that search a height map for the horizon.
namespace terrazzo {

/// Parameter "radius".
Param horizon_radius_param();

/// From the parameters "height_scale", "radius" and "edges".
HorizonOptions horizon_options_of(const NodeContext& node);

/// An operation on a height map that reads as far as the horizon is looked for; it lacks `compute`.
Operation horizon_operation(const ImagePtr& height, const HorizonOptions& options);

}  // namespace terrazzo
