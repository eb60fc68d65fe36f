#pragma once

#include <memory>

#include "core/image/image.h"
#include "core/resolve/fine_layout.h"
#include "core/resolve/kept_pixels.h"
#include "core/resolve/slow_tones.h"

namespace terrazzo {

/// A resolved map whose slow tones meet at seams: the lowest band of a multiresolution spline (Burt & Adelson, A
/// multiresolution spline with application to image mosaics, 1983). Everything finer stays as it is.
///
/// `resolved`: the map without it, of the layout's size; `map`: the exemplar's, whose range of values is kept. Every
/// pixel within reach proposes the tone with which its piece would continue; where their mean differs from the tone of
/// the pixel's own piece by more than tones vary nearby, the pixel is moved there, in the stored values, which for
/// colours are close to what the eye sees. All other pixels stay bit for bit. Normals keep their length.
///
/// Kept pixels stay bit for bit, and the tones around them turn to theirs.
///
/// Computed on demand, bit-exact for any region; depends on the layout up to 1.25 times the tones' reach away.
ImagePtr joined_tones(const ImagePtr& resolved, const ImagePtr& map, std::shared_ptr<const FineLayout> layout,
                      SlowTonesPtr tones, const KeptPixels& kept, const Task& task);

}  // namespace terrazzo
