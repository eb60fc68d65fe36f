#pragma once

#include "core/exemplar/uv_map.h"
#include "core/image/image.h"

namespace terrazzo {

/// A uv map as a picture of two channels, for EXR: u = (x + 0.5) / exemplar width, v = (y + 0.5) / exemplar height,
/// v counting downwards from the top. x = floor(u * width) gives the exemplar pixel back exactly.
ImagePtr uv_as_fractions(const UvMapPtr& uv);

/// A uv map as a picture of three channels, for 16-bit PNG and TIFF: red is x / 65535, green y / 65535, so that the
/// file holds the exemplar pixel's integer coordinates; blue is 0.
ImagePtr uv_as_integers(const UvMapPtr& uv);

/// The way back, from a picture of either kind: 16-bit values are read as integers, floats as fractions. Throws Error
/// if the picture has fewer than two channels, another depth, or names a place outside the exemplar.
UvMapPtr uv_from_image(const Image& image, Size exemplar, UvWraps wraps = {});

}  // namespace terrazzo
