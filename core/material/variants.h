#pragma once

#include "core/material/material.h"

/// Rotated, mirrored and scaled copies of an exemplar. Maps are computed on demand.
namespace terrazzo {

/// A material and the part of it that may be sampled.
struct Exemplar {
  MaterialPtr material;
  ImagePtr mask;  ///< one channel of the material's aspect ratio, above 0.5 where it may be sampled; null: everywhere
};

/// A transformation of an exemplar, applied in this order.
struct Variant {
  double scale = 1;
  bool mirror_x = false;  ///< left becomes right
  bool mirror_y = false;  ///< top becomes bottom
  double rotation = 0;    ///< degrees, counter-clockwise as seen on the screen
  bool operator==(const Variant&) const = default;
};

/// The transformed exemplar. Thread-safe.
///
/// Mirroring and rotation by multiples of 90 degrees only move pixels; other rotations interpolate (Keys, Cubic
/// convolution interpolation, 1981) in a material large enough to hold the rotated one. With `outside` clamp its
/// corners are masked out; with wrap the exemplar fills them. Masks and guidance are sampled, never interpolated.
///
/// Normals turn with the surface. Scaling is in all three dimensions: normals stay, and heights scale about their mean
/// (8- and 16-bit maps clip to 0..1).
Exemplar varied(const Exemplar& exemplar, const Variant& variant, Outside outside);

/// How many times smaller than the material a map is, if a whole number and equal in x and y; else 1.
int divisor_of(Size map, Size material);

}  // namespace terrazzo
