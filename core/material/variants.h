#pragma once

#include "core/material/material.h"

/// Rotated, mirrored and scaled copies of an exemplar. Maps are computed when pulled.
namespace terrazzo {

/// A material and a mask of the pixels that may be sampled.
struct Exemplar {
  MaterialPtr material;
  ImagePtr mask;  ///< one channel of the material's aspect ratio, above 0.5 where it may be sampled; null: everywhere
};

/// A transformation of an exemplar. The members are applied in order.
struct Variant {
  double scale = 1;
  bool mirror_x = false;  ///< left becomes right
  bool mirror_y = false;  ///< top becomes bottom
  double rotation = 0;    ///< degrees, counter-clockwise on screen
  bool operator==(const Variant&) const = default;
};

/// The transformed exemplar. Thread-safe.
///
/// Mirroring and rotation by multiples of 90 degrees only move pixels. Other rotations interpolate (Keys, Cubic
/// convolution interpolation, 1981) and enlarge the material to the bounding box. With `outside` clamp its corners are
/// masked out; with wrap the exemplar fills them. Masks and guidance are sampled, never interpolated.
///
/// Normals rotate with the surface. Scaling applies to all three dimensions: normals stay, and heights scale about
/// their mean (8- and 16-bit maps clip to 0..1).
Exemplar varied(const Exemplar& exemplar, const Variant& variant, Outside outside);

/// The integer factor by which a map is smaller than the material, if it is the same in x and y; else 1.
int divisor_of(Size map, Size material);

}  // namespace terrazzo
