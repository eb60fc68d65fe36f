#pragma once

#include "core/node/node.h"

/// How nodes that derive maps from others continue them beyond their borders.
namespace terrazzo {

/// Parameter "edges" of such nodes: auto, clamp or wrap.
Param derived_edges_param();

/// The parameter's value for the source material or image. "auto" compares opposite borders, of large maps at a reduced
/// size, and adds a note if they match. Throws Cancelled.
Outside derived_edges_of(NodeContext& node, const Material& material);
Outside derived_edges_of(NodeContext& node, const ImagePtr& image);

/// Remembers the edges of a derived image, so that later nodes need not pull its pixels to compare borders.
/// Thread-safe.
void know_edges(const ImagePtr& derived, Outside edges);

}  // namespace terrazzo
