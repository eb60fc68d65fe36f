#pragma once

#include "core/procedural/surface.h"

namespace terrazzo {

/// The position of a point on its brick, relative to the brick's centre, in units of the canvas. The half sides extend
/// to the middle of the joints.
struct Brick {
  double x, y;
  double half_width, half_height;
  uint64_t bits;
};

/// The dimensions of bricks including joints, in units of the canvas; the joint's width is a fraction of the height.
struct Course {
  double height, length;
  double joint = 0.17;
};

/// The appearance of bricks and mortar, independent of the bond. Immutable.
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
  double per_brick_;  ///< bricks per unit: the frequency of per-brick details
  double mortar_;     ///< the width of a joint
};

}  // namespace terrazzo
