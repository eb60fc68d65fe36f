#pragma once

#include "core/procedural/surface.h"

namespace terrazzo {

/// The appearance of stones and joints. Lengths are fractions of a stone's mean size.
struct StoneLook {
  double joint = 0.1;     ///< width of the joints
  double rounding = 0.2;  ///< distance from the edge at which the face curves down
  double edge = 0.03;     ///< raggedness of the edges
  double hollow = 0.4;    ///< depth of the joints as a fraction of the height
  double rough = 0.2;     ///< relief of the face as a fraction of the height
  double facets = 0;      ///< share of that relief in split planes
  double riven = 0;       ///< share of that relief in the steps of split layers
  double tooled = 0;      ///< strength of the mason's chisel marks
  double grains = 1;      ///< strength of the crystals
};

/// A point of a stone or of the joint around it.
struct StonePlace {
  double x, y;      ///< from the stone's middle, in units of the canvas
  double distance;  ///< to the middle of the nearest joint
  uint64_t bits;    ///< random bits of the stone
};

/// The appearance of stones and mortar, independent of the layout. Immutable.
class StoneFace {
 public:
  /// `unit`: the mean size of a stone in units of the canvas.
  StoneFace(const Canvas& canvas, const PatternSpec& spec, const Palette& palette, const StoneLook& look, double unit);
  SurfacePoint at(double u, double v, const StonePlace& place) const;

 private:
  struct Relief {
    double waves, fine, height;
  };
  Relief relief_at(double u, double v, const StonePlace& place, Dice& dice) const;
  SurfacePoint stone_at(double u, double v, const StonePlace& place, double round, Dice& dice) const;
  SurfacePoint mortar_at(double u, double v, double d) const;
  SurfacePoint weathered(double u, double v, SurfacePoint point, double low) const;

  Canvas canvas_;
  PatternSpec spec_;
  Palette palette_;
  StoneLook look_;
  double unit_;
};

/// The scale, limited to one piece per pixel: finer pieces would be invisible and take unbounded memory.
double visible_scale(const PatternSpec& spec);

}  // namespace terrazzo
