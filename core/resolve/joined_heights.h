#pragma once

#include <memory>

#include "core/base/task.h"
#include "core/image/image.h"
#include "core/resolve/fine_layout.h"
#include "core/resolve/kept_pixels.h"

namespace terrazzo {

/// Whether a map can be joined: only one-channel heights.
bool can_join(const ImageInfo& info);

/// A height map resolved through a layout, with pieces raised and lowered so that they meet (gradient-domain
/// compositing: Perez, Gangnet & Blake, Poisson image editing, 2003; screened as in Bhat et al., Fourier analysis of
/// the 2D screened Poisson equation, 2008).
///
/// Target gradients are the exemplar's within pieces. Across a seam, the target is the value nearest to the actual step
/// in the range between the slopes of both pieces' continuations, so that a cliff of either piece remains. The
/// screening term, a weak pull to the exemplar's heights, limits corrections to about `reach` pixels of the uv map
/// around a seam. Heights are clamped to the exemplar's range.
///
/// The coarse solution is computed immediately, in 2.7 bytes per output pixel, of which 1 remains; the rest is computed
/// on demand, bit-exact for any region. Wraps as the layout. Non-finite values stay and are ignored. Kept heights stay
/// bit for bit; everything else adapts to them. Throws Cancelled.
ImagePtr joined_heights(const ImagePtr& map, const std::shared_ptr<const FineLayout>& layout, double reach,
                        const KeptPixels& kept, const Task& task);

}  // namespace terrazzo
