#pragma once

#include <cstdint>

#include "core/image/image.h"

namespace terrazzo {

/// Blend modes, named as in paint programs.
enum class BlendMode : uint8_t {
  normal,      ///< the top
  multiply,    ///< base * top
  screen,      ///< 1 - (1 - base) (1 - top)
  overlay,     ///< multiply where the base is dark, screen where it is light
  add,         ///< base + top
  subtract,    ///< base - top
  difference,  ///< |base - top|
  min,
  max,
};

/// A base, and a top blended over it where the mask is 1. Top and mask may have a single channel that applies to all
/// channels of the base.
struct BlendInputs {
  ImagePtr base;
  ImagePtr top;
  ImagePtr mask;       ///< null: everywhere
  double opacity = 1;  ///< factor on the mask
};

/// Blends values when pulled. If `linear`, srgb_texture colours are blended in linear light, else as stored. The result
/// has the base's description.
ImagePtr blend_values(const BlendInputs& inputs, BlendMode mode, bool linear, const Digest& recipe);

/// Blends normals when pulled, in the base's convention. With `detail` the top is added to the base (reoriented normal
/// mapping), flattened where the mask is dark; else the mask interpolates between the two and the result is normalised.
ImagePtr blend_normals(const BlendInputs& inputs, bool detail, const Digest& recipe);

}  // namespace terrazzo
