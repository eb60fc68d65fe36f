#include "core/procedural/noise.h"

#include <array>
#include <cmath>

#include "core/base/portable_math.h"

namespace terrazzo {

namespace {

using portable::floor_int;

uint64_t corner(uint64_t seed, int64_t x, int64_t y, Period period) {
  return lattice_bits(seed, wrapped(x, period.x), wrapped(y, period.y));
}

double quintic(double t) {
  return t * t * t * (t * (t * 6 - 15) + 10);
}

struct Direction {
  double x, y;
};

constexpr int direction_count = 64;

const std::array<Direction, direction_count>& directions() {
  static const auto all = [] {
    std::array<Direction, direction_count> d{};
    for (int i = 0; i < direction_count; i++) {
      const double turns = (i + 0.5) / direction_count;
      d[i] = {portable::cos_turns(turns), portable::sin_turns(turns)};
    }
    return d;
  }();
  return all;
}

double slope(uint64_t bits, double dx, double dy) {
  const Direction& d = directions()[bits >> 58];
  return d.x * dx + d.y * dy;
}

}  // namespace

double value_noise(double x, double y, uint64_t seed, Period period) {
  const int64_t i = floor_int(x), j = floor_int(y);
  const double tx = quintic(x - double(i)), ty = quintic(y - double(j));
  const auto value = [&](int64_t a, int64_t b) { return unit_double(corner(seed, a, b, period)) * 2 - 1; };
  return portable::mix(portable::mix(value(i, j), value(i + 1, j), tx),
                       portable::mix(value(i, j + 1), value(i + 1, j + 1), tx), ty);
}

double gradient_noise(double x, double y, uint64_t seed, Period period) {
  const int64_t i = floor_int(x), j = floor_int(y);
  const double fx = x - double(i), fy = y - double(j), tx = quintic(fx), ty = quintic(fy);
  const double top =
      portable::mix(slope(corner(seed, i, j, period), fx, fy), slope(corner(seed, i + 1, j, period), fx - 1, fy), tx);
  const double bottom = portable::mix(slope(corner(seed, i, j + 1, period), fx, fy - 1),
                                      slope(corner(seed, i + 1, j + 1, period), fx - 1, fy - 1), tx);
  // Four unit gradients can reach sqrt(1/2) at the middle of a cell.
  return portable::mix(top, bottom, ty) * 1.4142135623730951;
}

double simplex_noise(double x, double y, uint64_t seed, Period period) {
  // Lattice point (i, j) lies at (i - j / 2, j): rows are shifted by half a cell.
  const double skewed = x + y * 0.5;
  const int64_t i = floor_int(skewed), j = floor_int(y);
  const double fx = skewed - double(i), fy = y - double(j);
  const bool upper = fx > fy;
  const int64_t corners[3][2] = {{i, j}, {i + (upper ? 1 : 0), j + (upper ? 0 : 1)}, {i + 1, j + 1}};
  double sum = 0;
  for (const auto& c : corners) {
    const double dx = x - (double(c[0]) - double(c[1]) * 0.5), dy = y - double(c[1]);
    const double w = 0.8 - dx * dx - dy * dy;
    if (w <= 0) continue;
    // One period down shifts the column by half a period.
    const int64_t row = wrapped(c[1], period.y), column = c[0] - (c[1] - row) / 2;
    sum += w * w * w * w * slope(lattice_bits(seed, wrapped(column, period.x), row), dx, dy);
  }
  return std::clamp(sum * 10.9, -1.0, 1.0);
}

CellPoint cell_noise(double x, double y, uint64_t seed, Period period, double jitter) {
  const int64_t i = floor_int(x), j = floor_int(y);
  CellPoint best;
  double nearest = 1e9, second = 1e9;
  for (int64_t b = j - 1; b <= j + 1; b++)
    for (int64_t a = i - 1; a <= i + 1; a++) {
      const uint64_t bits = corner(seed, a, b, period);
      const double px = double(bits & 0xffff) / 65536 - 0.5, py = double((bits >> 16) & 0xffff) / 65536 - 0.5;
      const double dx = x - (double(a) + 0.5 + px * jitter), dy = y - (double(b) + 0.5 + py * jitter);
      const double distance = dx * dx + dy * dy;
      if (distance < nearest) {
        second = nearest;
        nearest = distance;
        best.bits = mix_bits(bits);
        best.dx = dx;
        best.dy = dy;
      } else if (distance < second) {
        second = distance;
      }
    }
  best.nearest = std::sqrt(nearest);
  best.second = std::sqrt(second);
  return best;
}

NoiseField::NoiseField(const NoiseSpec& spec, Size size) : spec_(spec) {
  const double aspect = double(size.height) / size.width;
  double across = spec.across, weight = 1;
  for (int k = 0; k < spec.octaves; k++) {
    double down = across * aspect;
    Period period;
    double columns = across;
    if (spec.tileable) {
      period.x = int(std::max<int64_t>(1, floor_int(columns + 0.5)));
      period.y = int(std::max<int64_t>(1, floor_int(down + 0.5)));
      if (spec.basis == NoiseBasis::simplex) period.y += period.y % 2;
      columns = period.x;
      down = period.y;
    }
    octaves_.push_back({columns / size.width, down / size.height, weight, period, random_bits(spec.seed, uint64_t(k))});
    total_ += weight;
    across *= spec.lacunarity;
    weight *= spec.gain;
  }
}

double NoiseField::at(int x, int y) const {
  double sum = 0, above = 1;
  for (const Octave& o : octaves_) {
    const double u = (x + 0.5) * o.cells_per_pixel_x, v = (y + 0.5) * o.cells_per_pixel_y;
    double n = 0;
    switch (spec_.basis) {
      case NoiseBasis::value:
        n = value_noise(u, v, o.seed, o.period);
        break;
      case NoiseBasis::gradient:
        n = gradient_noise(u, v, o.seed, o.period);
        break;
      case NoiseBasis::simplex:
        n = simplex_noise(u, v, o.seed, o.period);
        break;
      case NoiseBasis::cells:
        n = std::min(1.0, cell_noise(u, v, o.seed, o.period).nearest) * 2 - 1;
        break;
      case NoiseBasis::cell_edges: {
        const CellPoint p = cell_noise(u, v, o.seed, o.period);
        n = std::min(1.0, p.second - p.nearest) * 2 - 1;
        break;
      }
    }
    switch (spec_.fractal) {
      case Fractal::fbm:
        sum += n * o.weight;
        break;
      case Fractal::turbulence:
        sum += std::abs(n) * o.weight;
        break;
      case Fractal::ridged: {
        // Finer ridges appear only where ridges are already high (Musgrave 1998).
        const double ridge = (1 - std::abs(n)) * (1 - std::abs(n));
        sum += ridge * above * o.weight;
        above = ridge;
        break;
      }
    }
  }
  sum /= total_;
  return portable::saturate(spec_.fractal == Fractal::fbm ? sum * 0.5 + 0.5 : sum);
}

ImagePtr noise_image(const NoiseSpec& spec, ImageInfo info, const Digest& recipe) {
  info.channels = 1;
  info.depth = Depth::u16;
  const NoiseField field(spec, info.size);
  return Image::computed(info, recipe, [field](const Rect& r, float* out) {
    for (int y = r.y; y < r.bottom(); y++)
      for (int x = r.x; x < r.right(); x++) *out++ = float(floor_int(field.at(x, y) * 65535 + 0.5)) / 65535.0f;
  });
}

}  // namespace terrazzo
