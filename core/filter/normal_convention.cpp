#include "core/filter/normal_convention.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/tuning.h"
#include "core/numeric/moments.h"

namespace terrazzo {

namespace {

struct NormalConventionTuning {
  double clear = 0.1;
  double strong = 0.5;
  double clear_curl = 0.2;
  int largest_grid = 512;
};
const Tunable<NormalConventionTuning> normal_convention_tuning(
    "normal_convention",
    {
        {&NormalConventionTuning::clear, "clear", "correlation",
         "of slopes and heights. Higher: more maps stay undecided; lower: noise decides",
         "not measured: taken over from the code before constants were listed", 0, 1},
        {&NormalConventionTuning::strong, "strong", "correlation",
         "the same along the one axis that has slopes, as of planks. Higher: grooves of one way stay undecided; lower: "
         "an inverted height map is not noticed",
         "not measured: taken over from the code before constants were listed", 0, 1},
        {&NormalConventionTuning::clear_curl, "clear_curl", "correlation",
         "of the two slopes of a normal map by itself. Higher: more maps stay undecided; lower: noise decides",
         "not measured: taken over from the code before constants were listed", 0, 1},
        {&NormalConventionTuning::largest_grid, "largest_grid", "cells a side",
         "over which maps are averaged. Higher: fine relief counts; costs time", "not measured: bounds the time"},
    });

/// Channels of an image averaged over the cells of a regular grid, one plane per channel.
struct Grid {
  Size size;
  std::vector<std::vector<double>> planes;
  double at(int plane, int x, int y) const { return planes[plane][size_t(y) * size.width + x]; }
};

Grid averaged(const Image& image, Size size) {
  Grid g{size, std::vector<std::vector<double>>(image.channels(), std::vector<double>(size.area()))};
  std::vector<float> band;
  for (int y = 0; y < size.height; y++) {
    const int y0 = int(int64_t{y} * image.height() / size.height);
    const int y1 = int(int64_t{y + 1} * image.height() / size.height);
    const Rect r{0, y0, image.width(), y1 - y0};
    band.resize(size_t(r.area()) * image.channels());
    image.read(r, band.data());
    for (int x = 0; x < size.width; x++) {
      const int x0 = int(int64_t{x} * image.width() / size.width);
      const int x1 = int(int64_t{x + 1} * image.width() / size.width);
      for (int c = 0; c < image.channels(); c++) {
        double sum = 0;
        for (int j = 0; j < r.height; j++)
          for (int i = x0; i < x1; i++) sum += band[(size_t(j) * r.width + i) * image.channels() + c];
        g.planes[c][size_t(y) * size.width + x] = sum / (double(r.height) * (x1 - x0));
      }
    }
  }
  return g;
}

/// Pearson's correlation; 0 if one of the two hardly varies.
double correlation(const Moments<2>& m) {
  constexpr double least = 1e-12;
  const double a = m.variance(0), b = m.variance(1);
  return a > least && b > least ? m.covariance(0, 1) / std::sqrt(a * b) : 0;
}

void add(double a, double b, Moments<2>& to) {
  to.add(Vector2d{a, b}.data());
}

Size common_grid(const Image& a, const Image& b) {
  const int largest = normal_convention_tuning->largest_grid;
  return {std::min({a.width(), b.width(), largest}), std::min({a.height(), b.height(), largest})};
}

/// Correlations of the channels of normals with slopes.
struct SlopeFit {
  double red_x = 0, red_y = 0, green_x = 0, green_y = 0;
};

/// The place in the height map of the point that a turned or mirrored normal map shows at (x, y).
std::pair<int, int> source_of(NormalMisfit::Kind kind, Size size, int x, int y) {
  using enum NormalMisfit::Kind;
  const int right = size.width - 1, bottom = size.height - 1;
  switch (kind) {
    case turned_90:
      return {y, right - x};
    case turned_180:
      return {right - x, bottom - y};
    case turned_270:
      return {bottom - y, x};
    case mirrored_x:
      return {right - x, y};
    case mirrored_y:
      return {x, bottom - y};
    case none:
    case channels_swapped:
      break;
  }
  return {x, y};
}

SlopeFit fit_of(const Grid& n, const Grid& h, NormalMisfit::Kind kind) {
  Moments<2> red_x, red_y, green_x, green_y;
  for (int y = 1; y + 1 < n.size.height; y++)
    for (int x = 1; x + 1 < n.size.width; x++) {
      const auto [u, v] = source_of(kind, n.size, x, y);
      const double along_x = h.at(0, u - 1, v) - h.at(0, u + 1, v), along_y = h.at(0, u, v + 1) - h.at(0, u, v - 1);
      add(n.at(0, x, y), along_x, red_x);
      add(n.at(0, x, y), along_y, red_y);
      add(n.at(1, x, y), along_x, green_x);
      add(n.at(1, x, y), along_y, green_y);
    }
  return {correlation(red_x), correlation(red_y), correlation(green_x), correlation(green_y)};
}

double fitness(const NormalMisfit& m) {
  return std::min(std::abs(m.along_x), std::abs(m.along_y));
}

}  // namespace

ConventionEvidence convention_from_height(const Image& normal, const Image& height) {
  ConventionEvidence out;
  const Size size = common_grid(normal, height);
  if (size.width < 3 || size.height < 3 || normal.channels() < 2) return out;
  const Grid n = averaged(normal, size), h = averaged(height, size);
  Moments<2> along_x, along_y;
  for (int y = 1; y + 1 < size.height; y++)
    for (int x = 1; x + 1 < size.width; x++) {
      add(n.at(0, x, y), h.at(0, x - 1, y) - h.at(0, x + 1, y), along_x);
      add(n.at(1, x, y), h.at(0, x, y + 1) - h.at(0, x, y - 1), along_y);
    }
  out.along_x = correlation(along_x);
  out.along_y = correlation(along_y);
  // Horizontal grooves, as of planks, leave red without evidence; then green must correlate strongly.
  const double clear = normal_convention_tuning->clear, strong = normal_convention_tuning->strong;
  if (std::abs(out.along_y) < (std::abs(out.along_x) < clear ? strong : clear)) return out;
  if (std::abs(out.along_x) < clear) {
    out.normal_y = out.along_y > 0 ? NormalY::up : NormalY::down;
    return out;
  }
  out.height_inverted = out.along_x < 0;
  out.normal_y = (out.along_x > 0) == (out.along_y > 0) ? NormalY::up : NormalY::down;
  return out;
}

NormalMisfit misfit_with_height(const Image& normal, const Image& height) {
  using enum NormalMisfit::Kind;
  const Size size = common_grid(normal, height);
  if (size.width < 3 || size.height < 3 || normal.channels() < 2) return {};
  const Grid n = averaged(normal, size), h = averaged(height, size);
  const double strong = normal_convention_tuning->strong;
  NormalMisfit best;
  for (const NormalMisfit::Kind kind : {none, turned_90, turned_180, turned_270, mirrored_x, mirrored_y}) {
    // The grid is not square either if height and normals differ in shape.
    const bool is_square = normal.width() == normal.height() && size.width == size.height;
    if ((kind == turned_90 || kind == turned_270) && !is_square) continue;
    const SlopeFit fit = fit_of(n, h, kind);
    const double straight = std::min(std::abs(fit.red_x), std::abs(fit.green_y));
    const double crossed = std::min(std::abs(fit.red_y), std::abs(fit.green_x));
    // Already fits, perhaps in one direction only, as with grooves.
    if (kind == none && std::max(std::abs(fit.red_x), std::abs(fit.green_y)) >= strong) return {};
    if (kind != none && straight >= strong && straight > fitness(best)) best = {kind, fit.red_x, fit.green_y};
    if (crossed >= strong && crossed > fitness(best))
      best = {kind == none ? channels_swapped : kind, fit.red_y, fit.green_x};
    if (kind == none && best.kind != none) return best;
  }
  return best;
}

double mean_blue(const Image& normal) {
  if (normal.channels() < 3) return 1;
  double sum = 0;
  for_each_strip(normal, [&](const Rect& r, const float* p) {
    for (int64_t i = 0; i < r.area(); i++) sum += p[i * normal.channels() + 2];
  });
  return sum / double(normal.size().area());
}

ConventionEvidence convention_from_curl(const Image& normal) {
  ConventionEvidence out;
  const int largest_grid = normal_convention_tuning->largest_grid;
  const Size size{std::min(normal.width(), largest_grid), std::min(normal.height(), largest_grid)};
  if (size.width < 3 || size.height < 3 || normal.channels() < 2) return out;
  const Grid n = averaged(normal, size);
  Moments<2> curl;
  for (int y = 1; y + 1 < size.height; y++)
    for (int x = 1; x + 1 < size.width; x++)
      add(n.at(0, x, y - 1) - n.at(0, x, y + 1), n.at(1, x + 1, y) - n.at(1, x - 1, y), curl);
  out.along_y = correlation(curl);
  if (std::abs(out.along_y) >= normal_convention_tuning->clear_curl)
    out.normal_y = out.along_y > 0 ? NormalY::up : NormalY::down;
  return out;
}

}  // namespace terrazzo
