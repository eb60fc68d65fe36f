#pragma once

#include "core/material/material.h"

/// Copies of an exemplar, turned and scaled, as further sources of synthesis. All maps are computed when pulled.
namespace terrazzo {

/// A material and the part of it that may be sampled.
struct Exemplar {
  MaterialPtr material;
  ImagePtr
      mask;  ///< one channel of the material's shape, above 0.5 where the material may be sampled; null: everywhere
};

/// What is done to an exemplar, in this order.
struct Variant {
  double scale = 1;
  bool mirror_x = false;  ///< left becomes right
  bool mirror_y = false;  ///< top becomes bottom
  double rotation = 0;    ///< degrees, counter-clockwise as seen on the screen
  bool operator==(const Variant&) const = default;
};

/// The exemplar as the variant says; thread-safe.
///
/// Mirroring and rotation by multiples of 90 degrees move pixels and change none; other rotations are interpolated
/// (Keys 1981, cubic convolution), in a material large enough to hold the rotated one. What it shows beyond the
/// exemplar's border follows `outside`: its corners are masked out where the border goes on, and are as good as the
/// rest where the exemplar wraps around. Masks and guidance are sampled, never interpolated.
///
/// Normals turn with the surface. Scaling is that of the whole body, heights too: slopes, and so normals, stay, while
/// heights part from their mean by `scale` times as much (and are clipped to 0..1 in maps of 8 and 16 bit).
Exemplar varied(const Exemplar& exemplar, const Variant& variant, Outside outside);

/// How many times smaller than the material a map is: the whole number, or 1 if it is none or differs in x and y.
int divisor_of(Size map, Size material);

}  // namespace terrazzo
