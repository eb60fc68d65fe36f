#pragma once

#include <cstdint>

#include "core/image/image.h"

namespace terrazzo {

/// How two images are put together; names as paint programs use them.
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

/// A base, and a top laid over it where the mask is white. Top and mask may have one channel for all of the base's.
struct BlendInputs {
  ImagePtr base;
  ImagePtr top;
  ImagePtr mask;       ///< null: everywhere
  double opacity = 1;  ///< factor on the mask
};

/// Values, blended when pulled; colours stored as srgb_texture in linear light if `linear`, else as stored. The result
/// is described as the base.
ImagePtr blend_values(const BlendInputs& inputs, BlendMode mode, bool linear, const Digest& recipe);

/// Normals in the base's convention. `detail`: the top is laid over the base (reoriented normal mapping), flattened
/// where the mask is dark; else the top replaces the base, and between the two vectors are mixed and made unit length.
ImagePtr blend_normals(const BlendInputs& inputs, bool detail, const Digest& recipe);

}  // namespace terrazzo
