#include "core/procedural/surface.h"

#include <cmath>

#include "core/base/portable_math.h"

namespace terrazzo {

namespace {

int whole_count(double n) {
  return int(std::max<int64_t>(1, portable::floor_int(n + 0.5)));
}

}  // namespace

Rgb saturated(const Rgb& color, double saturation) {
  const double grey = 0.3 * color.r + 0.59 * color.g + 0.11 * color.b;
  return mix({grey, grey, grey}, color, saturation);
}

Canvas::Canvas(Size size, bool wraps, uint64_t seed)
    : wraps_(wraps), aspect_(double(size.height) / size.width), pixel_(1.0 / size.width), seed_(seed) {}

Canvas::Scaled Canvas::scaled(double u, double v, double across) const {
  if (!wraps_) return {u * across, v * across, {}};
  const Period period{whole_count(across), whole_count(across * aspect_)};
  return {u * period.x, v * (period.y / aspect_), period};
}

double Canvas::noise(double u, double v, double across, uint64_t salt) const {
  const Scaled s = scaled(u, v, across);
  return gradient_noise(s.x, s.y, seed_ ^ (salt * 0x9e3779b97f4a7c15ULL), s.period);
}

double Canvas::fbm(double u, double v, double across, int octaves, double gain, uint64_t salt) const {
  double sum = 0, weight = 1, total = 0;
  for (int k = 0; k < octaves; k++) {
    if (k == 0 || across * pixel_ <= 0.5) sum += weight * noise(u, v, across, salt * 64 + k);
    total += weight;
    across *= 2;
    weight *= gain;
  }
  return sum / total;
}

CellPoint Canvas::cells(double u, double v, double across, uint64_t salt, double jitter) const {
  const Scaled s = scaled(u, v, across);
  return cell_noise(s.x, s.y, seed_ ^ (salt * 0x9e3779b97f4a7c15ULL), s.period, jitter);
}

Grid::Grid(const Canvas& canvas, double columns, double rows_per_column, int row_multiple) : seed_(canvas.seed()) {
  double rows = columns * rows_per_column * canvas.aspect();
  if (canvas.wraps()) {
    period_ = {whole_count(columns), whole_count(rows / row_multiple) * row_multiple};
    columns = period_.x;
    rows = period_.y;
  }
  cell_width_ = 1 / columns;
  cell_height_ = canvas.aspect() / rows;
}

uint64_t Grid::bits(int64_t column, int64_t row, uint64_t salt) const {
  return lattice_bits(seed_ ^ (salt * 0x9e3779b97f4a7c15ULL), wrapped_column(column), wrapped_row(row));
}

uint64_t Grid::id(int64_t column, int64_t row) const {
  return uint64_t{uint32_t(wrapped_column(column))} | uint64_t{uint32_t(wrapped_row(row))} << 32;
}

int64_t Grid::wrapped_column(int64_t column) const {
  return wrapped(column, period_.x);
}

int64_t Grid::wrapped_row(int64_t row) const {
  return wrapped(row, period_.y);
}

Rgb pick_color(const std::vector<Rgb>& colors, Dice& dice) {
  const Rgb& first = colors[size_t(dice.unit() * double(colors.size()))];
  const Rgb& second = colors[size_t(dice.unit() * double(colors.size()))];
  return mix(first, second, dice.unit() * 0.5);
}

double rounded_box(double x, double y, double half_width, double half_height, double radius) {
  const double dx = std::abs(x) - half_width + radius, dy = std::abs(y) - half_height + radius;
  const double ox = std::max(dx, 0.0), oy = std::max(dy, 0.0);
  return std::sqrt(ox * ox + oy * oy) + std::min(std::max(dx, dy), 0.0) - radius;
}

}  // namespace terrazzo
