#include "core/filter/slow_light.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/portable_math.h"
#include "core/base/tuning.h"
#include "core/filter/linear_colors.h"

namespace terrazzo {

namespace {

struct SlowLightTuning {
  double significance = 4;
  double chroma_weight = 1;
};
const Tunable<SlowLightTuning> slow_light_tuning(
    "slow_light",
    {{&SlowLightTuning::significance, "significance", "powers of quicker functions",
      "higher: light must be stronger to be found; lower: tones of the surface pass for light", "delight"},
     {&SlowLightTuning::chroma_weight, "chroma_weight", "powers of brightness",
      "higher: coloured light is left in; lower: patches of another colour are levelled", "delight"}});

constexpr int cells = SlowLight::least_side;  ///< per side; the picture is averaged over them
constexpr int orders = 8;                     ///< of all functions; those above `detail` tell what is chance
constexpr double darkest_cell = 1e-4;         ///< linear; keeps logarithms finite
constexpr double least_visible = 0.004;       ///< root mean square of logarithms: a step of 8 bits in mid tones

/// Functions along an axis, orthonormal over the centres of the cells, slow ones first; the first is 1.
struct Functions {
  std::vector<int> order;
  std::vector<std::vector<double>> at_cells, at_pixels;

  void add(int of_order, std::vector<double> in_cells, std::vector<double> in_pixels) {
    for (size_t k = 0; k < order.size(); k++) {
      double shared = 0;
      for (size_t i = 0; i < cells; i++) shared += in_cells[i] * at_cells[k][i] / cells;
      for (size_t i = 0; i < cells; i++) in_cells[i] -= shared * at_cells[k][i];
      for (size_t i = 0; i < in_pixels.size(); i++) in_pixels[i] -= shared * at_pixels[k][i];
    }
    double squares = 0;
    for (const double v : in_cells) squares += v * v / cells;
    const double scale = 1 / std::sqrt(squares);
    for (double& v : in_cells) v *= scale;
    for (double& v : in_pixels) v *= scale;
    order.push_back(of_order);
    at_cells.push_back(std::move(in_cells));
    at_pixels.push_back(std::move(in_pixels));
  }
};

/// The centres of `count` parts of the line 0..1.
std::vector<double> centres(int count) {
  std::vector<double> out;
  for (int i = 0; i < count; i++) out.push_back((i + 0.5) / count);
  return out;
}

template <typename F>
std::vector<double> each(std::vector<double> values, const F& f) {
  for (double& v : values) v = f(v);
  return values;
}

Functions functions_along(int pixels, bool wraps) {
  Functions out;
  const std::vector<double> in_cells = centres(cells), in_pixels = centres(pixels);
  out.add(0, std::vector<double>(in_cells.size(), 1.0), std::vector<double>(in_pixels.size(), 1.0));
  for (int k = 1; k <= orders; k++) {
    if (wraps) {
      for (const double phase : {0.25, 0.0}) {  // cosine and sine
        const auto wave = [&](double t) { return portable::sin_turns(k * t + phase); };
        out.add(k, each(in_cells, wave), each(in_pixels, wave));
      }
      continue;
    }
    // The line times the last function: Gram's polynomials, without the cancellation of powers.
    std::vector<double> longer = out.at_cells.back(), of_pixels = out.at_pixels.back();
    for (size_t i = 0; i < longer.size(); i++) longer[i] *= 2 * in_cells[i] - 1;
    for (size_t i = 0; i < of_pixels.size(); i++) of_pixels[i] *= 2 * in_pixels[i] - 1;
    out.add(k, std::move(longer), std::move(of_pixels));
  }
  return out;
}

using Plane = std::vector<double>;  ///< a value per cell, row by row

/// Logarithms of means over cells: of luminance, and the two ratios of colours.
std::array<Plane, 3> logarithms_of_cells(const ImagePtr& color, const ImagePtr& opacity) {
  constexpr size_t area = size_t(cells) * cells;
  std::array<Plane, 4> sums;
  for (Plane& p : sums) p.assign(area, 0.0);
  const ImagePtr linear = linear_colors(color, opacity);
  const Size size = color->size();
  for_each_strip(*linear, [&](const Rect& r, const float* v) {
    for (int y = r.y; y < r.bottom(); y++) {
      const size_t row = size_t(int64_t{y} * cells / size.height) * cells;
      for (int x = 0; x < r.width; x++, v += 4) {
        if (v[3] == 0) continue;
        const size_t cell = row + size_t(int64_t{x} * cells / size.width);
        for (size_t c = 0; c < 3; c++) sums[c][cell] += double(v[c]);
        sums[3][cell]++;
      }
    }
  });
  std::array<Plane, 3> out;
  for (size_t i = 0; i < area; i++) {
    const double count = std::max(sums[3][i], 1.0);
    const auto logarithm = [&](double sum) { return portable::log(std::max(sum / count, darkest_cell)); };
    const double red = logarithm(sums[0][i]), green = logarithm(sums[1][i]), blue = logarithm(sums[2][i]);
    out[0].push_back(logarithm(luminance(sums[0][i], sums[1][i], sums[2][i])));
    out[1].push_back(red - green);
    out[2].push_back(blue - green);
  }
  // Cells without a visible pixel are as the mean of the others.
  for (Plane& plane : out) {
    double mean = 0, seen = 0;
    for (size_t i = 0; i < area; i++)
      if (sums[3][i] > 0) {
        mean += plane[i];
        seen++;
      }
    for (size_t i = 0; i < area; i++)
      if (sums[3][i] == 0) plane[i] = seen > 0 ? mean / seen : 0;
  }
  return out;
}

/// The coefficients of a plane: rows for the functions down, columns for those across.
std::vector<Plane> projected(const Plane& plane, const Functions& down, const Functions& across) {
  std::vector<Plane> out;
  for (const auto& vertical : down.at_cells) {
    Plane column(cells, 0.0);
    for (size_t y = 0; y < cells; y++)
      for (size_t x = 0; x < cells; x++) column[x] += plane[y * cells + x] * vertical[y] / cells;
    Plane row;
    for (const auto& horizontal : across.at_cells) {
      double sum = 0;
      for (size_t x = 0; x < cells; x++) sum += column[x] * horizontal[x] / cells;
      row.push_back(sum);
    }
    out.push_back(std::move(row));
  }
  return out;
}

/// Sums of squares by order, and how many there are.
struct Power {
  double brightness = 0, chroma = 0;
  int count = 0;
};

}  // namespace

SlowLight::SlowLight(const ImagePtr& color, const ImagePtr& opacity, int detail, bool wraps) : size_(color->size()) {
  if (std::min(size_.width, size_.height) < least_side) return;
  const Functions across = functions_along(size_.width, wraps), down = functions_along(size_.height, wraps);
  const auto planes = logarithms_of_cells(color, opacity);
  std::vector<Plane> brightness = projected(planes[0], down, across);
  const std::vector<Plane> red = projected(planes[1], down, across), blue = projected(planes[2], down, across);

  const size_t count = across.order.size();
  std::array<Power, orders + 1> powers;
  Power chance;
  for (size_t j = 0; j < count; j++)
    for (size_t i = 0; i < count; i++) {
      const int order = down.order[j] + across.order[i];
      if (order < 1 || order > orders) continue;
      Power& p = order <= detail ? powers[size_t(order)] : chance;
      p.brightness += brightness[j][i] * brightness[j][i];
      p.chroma += red[j][i] * red[j][i] + blue[j][i] * blue[j][i];
      p.count++;
    }
  const double usual = chance.brightness / chance.count;
  std::array<double, orders + 1> gain{};
  double squares = 0;
  for (int order = 1; order <= detail; order++) {
    const Power& p = powers[size_t(order)];
    const double power = p.brightness / p.count, chroma = slow_light_tuning->chroma_weight * p.chroma / p.count;
    if (power - chroma <= slow_light_tuning->significance * usual) continue;
    gain[size_t(order)] = 1 - (usual + chroma) / power;  // Wiener's
    squares += p.brightness * gain[size_t(order)] * gain[size_t(order)];
  }
  if (squares < least_visible * least_visible) return;

  for (size_t i = 0; i < count; i++) functions_ += across.order[i] <= detail;
  for (int x = 0; x < size_.width; x++)
    for (size_t i = 0; i < functions_; i++) across_.push_back(across.at_pixels[i][size_t(x)]);
  for (int y = 0; y < size_.height; y++)
    for (size_t i = 0; i < functions_; i++) {
      double factor = 0;
      for (size_t j = 0; j < functions_; j++)
        if (const int order = down.order[j] + across.order[i]; order <= detail)
          factor += gain[size_t(order)] * brightness[j][i] * down.at_pixels[j][size_t(y)];
      down_.push_back(factor);
    }
}

double SlowLight::contrast() const {
  if (!is_any()) return 1;
  double least = 0, most = 0;
  std::vector<double> row(size_t(size_.width));
  for (int y = 0; y < size_.height; y++) {
    logarithms(0, y, size_.width, row.data());
    const auto [low, high] = std::minmax_element(row.begin(), row.end());
    least = std::min(least, *low);
    most = std::max(most, *high);
  }
  return portable::exp(most - least);
}

void SlowLight::logarithms(int x, int y, int count, double* out) const {
  if (!is_any()) {
    std::fill_n(out, count, 0.0);
    return;
  }
  const double* factors = &down_[size_t(y) * functions_];
  const double* values = &across_[size_t(x) * functions_];
  for (int i = 0; i < count; i++, values += functions_) {
    double sum = 0;
    for (size_t k = 0; k < functions_; k++) sum += factors[k] * values[k];
    out[i] = sum;
  }
}

}  // namespace terrazzo
