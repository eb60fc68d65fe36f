#pragma once

#include <cstdint>
#include <vector>

#include "core/base/geometry.h"
#include "core/base/hash.h"
#include "core/image/image.h"

/// Lattice noises over counter-based hashes: a value depends only on position and seed, so any window of a noise equals
/// the same window of the whole, bit for bit. All functions are thread-safe.
namespace terrazzo {

/// The period of a noise in lattice cells, across and down; 0: none.
struct Period {
  int x = 0;
  int y = 0;
};

/// `v` modulo `period`, in [0, period); `v` itself if it is 0.
inline int64_t wrapped(int64_t v, int period) {
  if (period == 0) return v;
  const int64_t m = v % period;
  return m < 0 ? m + period : m;
}

/// Random bits of lattice point (x, y).
inline uint64_t lattice_bits(uint64_t seed, int64_t x, int64_t y) {
  const uint64_t at = static_cast<uint32_t>(x) | uint64_t{static_cast<uint32_t>(y)} << 32;
  return mix_bits(at ^ mix_bits(seed + 0x9e3779b97f4a7c15ULL));
}

/// Random values at lattice points, joined by a quintic; in [-1, 1].
double value_noise(double x, double y, uint64_t seed, Period period);
/// Gradient noise (Perlin, Improving noise, 2002), here with gradients evenly spread over the circle; in [-1, 1].
double gradient_noise(double x, double y, uint64_t seed, Period period);
/// Gradient noise on a triangular lattice, without the axis-aligned artefacts of a square one; in [-1, 1]. Vertical
/// periods must be even.
double simplex_noise(double x, double y, uint64_t seed, Period period);

/// The nearest of the random points that lie one in each lattice cell (Worley 1996).
struct CellPoint {
  double nearest = 0;  ///< distance to the nearest point, in cells
  double second = 0;   ///< distance to the second nearest
  uint64_t bits = 0;   ///< random bits of the nearest point
  double dx = 0;       ///< from the nearest point to (x, y)
  double dy = 0;
};
/// `jitter` in [0, 1]: how far points deviate from their cell's centre.
CellPoint cell_noise(double x, double y, uint64_t seed, Period period, double jitter = 1);

enum class NoiseBasis : uint8_t { value, gradient, simplex, cells, cell_edges };
enum class Fractal : uint8_t { fbm, ridged, turbulence };

struct NoiseSpec {
  NoiseBasis basis = NoiseBasis::gradient;
  Fractal fractal = Fractal::fbm;
  double across = 8;  ///< lattice cells of the first octave across the image
  int octaves = 5;
  double lacunarity = 2;  ///< each octave is this much finer; rounded to whole periods where the noise tiles
  double gain = 0.5;      ///< each octave is this much weaker
  uint64_t seed = 1;
  bool tileable = false;
};

/// A noise picture: a pure function of the pixel.
class NoiseField {
 public:
  NoiseField(const NoiseSpec& spec, Size size);
  /// In [0, 1], at the centre of pixel (x, y).
  double at(int x, int y) const;

 private:
  struct Octave {
    double cells_per_pixel_x, cells_per_pixel_y, weight;
    Period period;
    uint64_t seed;
  };
  NoiseSpec spec_;
  std::vector<Octave> octaves_;
  double total_ = 0;
};

/// The noise as an image of one channel, computed when pulled, in steps of 1/65535. `recipe` must cover the spec, see
/// Image::computed. `info` gives size and semantic.
ImagePtr noise_image(const NoiseSpec& spec, ImageInfo info, const Digest& recipe);

}  // namespace terrazzo
