#pragma once

#include <memory>

#include "core/base/task.h"
#include "core/image/image.h"
#include "core/resolve/fine_layout.h"
#include "core/resolve/kept_heights.h"

namespace terrazzo {

/// Whether such a map's pieces can be joined: heights, of one channel.
bool can_join(const ImageInfo& info);

/// A height map resolved through a layout, with its pieces raised and lowered so that they meet (gradient-domain
/// compositing: Perez, Gangnet & Blake, Poisson image editing, 2003; screened as by Bhat et al., Fourier analysis of
/// the 2D screened Poisson equation, 2008).
///
/// The result has the exemplar's slopes within pieces and, across a seam, a slope between those with which the pieces
/// on both sides would have gone on; of these the one that is nearest to what was there, so that a cliff that one of
/// them has at that place remains. Where that does not add up, the rest is spread evenly over the surroundings. A weak
/// pull to the exemplar's own heights keeps them within what they were: a difference at a seam is made up for within
/// about `reach` pixels of the uv map. Heights stay within those that the exemplar has.
///
/// The coarse part of the solution is worked out at once, in 2.7 bytes per output pixel, of which 1 stays; the rest
/// when pixels are pulled, the same bits whatever region is read. Wraps as the layout does; beyond other borders is
/// nothing to be joined to. What is not finite in the exemplar stays as it is and moves nothing. What is kept is shown
/// bit for bit, and all else gives way to it.
ImagePtr joined_heights(const ImagePtr& map, const std::shared_ptr<const FineLayout>& layout, double reach,
                        const KeptHeights& kept, const Task& task);

}  // namespace terrazzo
