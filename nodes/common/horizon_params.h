#pragma once

#include "core/filter/occlusion.h"
#include "nodes/common/derived_edges.h"
#include "nodes/common/node_helpers.h"

/// Helpers for nodes that search a height map for the horizon.
namespace terrazzo {

/// Parameter "radius".
Param horizon_radius_param();

/// From the parameters "height_scale", "radius" and "edges"; see `derived_edges_of`.
HorizonOptions horizon_options_of(NodeContext& node, const ImagePtr& height);

/// An operation on a height map that reads the search radius around each region. The caller sets `compute`.
Operation horizon_operation(const ImagePtr& height, const HorizonOptions& options);

}  // namespace terrazzo
