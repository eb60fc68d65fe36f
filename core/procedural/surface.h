#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/base/geometry.h"
#include "core/procedural/noise.h"

/// The basis of pattern types: a canvas with wrapping noises, colours, and the interface of surfaces.
namespace terrazzo {

/// An sRGB-encoded colour, 0..1. Patterns mix encoded colours, which approximates perception.
struct Rgb {
  double r = 0, g = 0, b = 0;
};
/// From 0xRRGGBB.
constexpr Rgb rgb(uint32_t hex) {
  return {double(hex >> 16 & 255) / 255, double(hex >> 8 & 255) / 255, double(hex & 255) / 255};
}
inline Rgb operator*(const Rgb& c, double f) {
  return {c.r * f, c.g * f, c.b * f};
}
inline Rgb operator+(const Rgb& a, const Rgb& b) {
  return {a.r + b.r, a.g + b.g, a.b + b.b};
}
inline Rgb mix(const Rgb& a, const Rgb& b, double t) {
  return a * (1 - t) + b * t;
}
/// Towards grey (saturation < 1) or away from it (> 1).
Rgb saturated(const Rgb& color, double saturation);

/// The colours of one look of a pattern.
struct Palette {
  std::string name;
  std::vector<Rgb> pieces;  ///< the colours of bricks, stones, yarns, ...
  Rgb joint;                ///< mortar, grout, earth between stones
  Rgb stain;                ///< dirt, moss, patina
};

struct PatternSpec {
  std::string type = "bricks";
  Size size{512, 512};
  uint64_t seed = 1;
  double scale = 0;           ///< pieces across the image; 0: the type's default
  double irregularity = 0.5;  ///< 0..1: variation of position, size and shape
  double wear = 0.5;          ///< 0..1: chips, pits, stains
  double relief = 1;          ///< depth as a multiple of the type's default
  std::string palette{};      ///< empty: the type's first
  bool tileable = true;
};

/// One point of a material's surface.
struct SurfacePoint {
  double height = 0.5;  ///< 0..1
  Rgb color;
  double roughness = 0.7;  ///< 0..1
};

/// The plane of a pattern: u in [0, 1) from left to right, v in [0, aspect) downwards, in the same unit. If it wraps,
/// its noises and grids repeat exactly at the borders.
class Canvas {
 public:
  Canvas(Size size, bool wraps, uint64_t seed);

  bool wraps() const { return wraps_; }
  double aspect() const { return aspect_; }
  double pixel() const { return pixel_; }  ///< the width of a pixel
  uint64_t seed() const { return seed_; }

  /// A noise of `across` cells per unit, in [-1, 1]. `salt` distinguishes the noises of one pattern.
  double noise(double u, double v, double across, uint64_t salt) const;
  /// Octaves of noise, each twice as fine as the one before and `gain` times as strong, in [-1, 1]; octaves finer than
  /// two pixels are left out.
  double fbm(double u, double v, double across, int octaves, double gain, uint64_t salt) const;
  CellPoint cells(double u, double v, double across, uint64_t salt, double jitter = 1) const;

 private:
  struct Scaled {
    double x, y;
    Period period;
  };
  Scaled scaled(double u, double v, double across) const;

  bool wraps_;
  double aspect_;
  double pixel_;
  uint64_t seed_;
};

/// A grid of `columns` x `rows` cells over the canvas; it wraps where the canvas does.
class Grid {
 public:
  /// `columns` per unit across, `rows_per_column` cells high for each cell wide. On a wrapping canvas both counts
  /// become whole numbers, and rows a multiple of `row_multiple`.
  Grid(const Canvas& canvas, double columns, double rows_per_column, int row_multiple = 1);

  double cell_width() const { return cell_width_; }
  double cell_height() const { return cell_height_; }
  /// Random bits of a cell, the same for cells that are one cell of the wrapped surface.
  uint64_t bits(int64_t column, int64_t row, uint64_t salt) const;
  /// A unique number of a cell, the same for cells that are one cell of the wrapped surface.
  uint64_t id(int64_t column, int64_t row) const;

 private:
  int64_t wrapped_column(int64_t column) const;
  int64_t wrapped_row(int64_t row) const;

  uint64_t seed_;
  double cell_width_;
  double cell_height_;
  Period period_;
};

/// A sequence of random numbers from one cell's bits.
class Dice {
 public:
  explicit Dice(uint64_t bits) : bits_(bits) {}
  /// In [0, 1).
  double unit() {
    bits_ = mix_bits(bits_ + 0x9e3779b97f4a7c15ULL);
    return unit_double(bits_);
  }
  /// In [-1, 1).
  double both() { return unit() * 2 - 1; }

 private:
  uint64_t bits_;
};

/// A colour between those of `colors`: one of them, blended with a second.
Rgb pick_color(const std::vector<Rgb>& colors, Dice& dice);

/// Signed distance to a rectangle of the given half sides with corners rounded to `radius`; negative inside.
double rounded_box(double x, double y, double half_width, double half_height, double radius);

/// A pattern's surface, evaluated point by point. Immutable; thread-safe.
class Surface {
 public:
  virtual ~Surface() = default;
  virtual SurfacePoint at(double u, double v) const = 0;
  /// The element (brick, stone, board ...) at a point; joints belong to the nearest element. An element that crosses
  /// the border of a wrapping canvas has one number. 0 everywhere if there are no elements.
  virtual uint64_t element(double, double) const { return 0; }
};

}  // namespace terrazzo
