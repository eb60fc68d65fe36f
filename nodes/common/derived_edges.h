#pragma once

#include "core/node/node.h"

/// What lies beyond the borders of maps from which a node derives others.
namespace terrazzo {

/// Parameter "edges" of such nodes: auto, clamp or wrap.
Param derived_edges_param();

/// Its value for what the node derives from. "auto" compares opposite borders, of large maps at a smaller size, and
/// says in a note if they meet. Throws Cancelled.
Outside derived_edges_of(NodeContext& node, const Material& material);
Outside derived_edges_of(NodeContext& node, const ImagePtr& image);

/// Makes it known of what a node has derived, so that no node behind it pulls pixels to find out. Thread-safe.
void know_edges(const ImagePtr& derived, Outside edges);

}  // namespace terrazzo
