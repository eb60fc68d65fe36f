#pragma once

#include "core/procedural/surface.h"

namespace terrazzo {

/// A brick as seen from a point: where the point lies on it, from its centre, along and across; lengths in units of the
/// canvas. The half sides reach to the middle of the joints.
struct Brick {
  double x, y;
  double half_width, half_height;
  uint64_t bits;
};

/// How bricks are laid: lengths in units of the canvas, with the joint; the joint's width as a fraction of the height.
struct Course {
  double height, length;
  double joint = 0.17;
};

/// What bricks and the mortar between them look like, however they are laid. Immutable.
class Masonry {
 public:
  Masonry(const Canvas& canvas, const PatternSpec& spec, const Palette& palette, const Course& course);
  /// The surface at (u, v), a point of `brick` or of the joint around it.
  SurfacePoint at(double u, double v, const Brick& brick) const;

 private:
  SurfacePoint brick_at(double u, double v, double along, const Rgb& base, double tone, double pitting, double burnt,
                        double burnt_side) const;
  SurfacePoint joint_at(double u, double v, double distance) const;
  SurfacePoint stained(double u, double v, SurfacePoint point) const;

  Canvas canvas_;
  PatternSpec spec_;
  Palette palette_;
  double unit_;       ///< the height of a course
  double per_brick_;  ///< bricks per unit: the frequency of details that come once per brick
  double mortar_;     ///< the width of a joint
};

}  // namespace terrazzo
