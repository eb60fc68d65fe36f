#pragma once

#include "core/image/image.h"

/// Base colours as light that a surface reflects, for estimates of the light that fell on it. Thread-safe.
namespace terrazzo {

/// Rec. 709.
template <typename T>
T luminance(T red, T green, T blue) {
  return T(0.2126) * red + T(0.7152) * green + T(0.0722) * blue;
}

/// Red, green and blue in linear light, finite and at least 0, grey repeated; and 1 where the pixel counts, else 0: by
/// the colour's alpha and the first channel of `opacity`, 0.5 or more. `opacity`: of the same size, or null. Computed
/// when pulled.
ImagePtr linear_colors(const ImagePtr& color, const ImagePtr& opacity);

}  // namespace terrazzo
