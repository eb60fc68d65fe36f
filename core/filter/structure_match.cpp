#include "core/filter/structure_match.h"

#include <algorithm>
#include <cmath>

#include "core/filter/resample.h"
#include "core/numeric/moments.h"

namespace terrazzo {

namespace {

double correlation(const std::vector<float>& a, const std::vector<float>& b) {
  Moments<2> m;
  for (size_t i = 0; i < a.size(); i++) {
    const float pair[2] = {a[i], b[i]};
    m.add(pair);
  }
  constexpr double least = 1e-12;
  const double product = m.variance(0) * m.variance(1);
  return product > least * least ? m.covariance(0, 1) / std::sqrt(product) : 0;
}

}  // namespace

Size structure_grid(Size a, Size b) {
  constexpr int largest = 128;  // enough to tell photographed exemplars apart; finer grids cost time and see noise
  return {std::min({a.width, b.width, largest}), std::min({a.height, b.height, largest})};
}

Structure structure_of(const ImagePtr& image, Size grid) {
  const std::vector<float> pixels =
      resampled(image, grid, "box", Outside::clamp, Hasher().add("structure").add(image->digest()).digest())->pixels();
  const int channels = image->channels();
  const int colours = channels % 2 == 0 && channels > 2 ? channels - 1 : channels;
  const bool is_normal = image->info().semantic == Semantic::normal;
  const auto at = [&](int x, int y, int c) {
    return pixels[(size_t(std::clamp(y, 0, grid.height - 1)) * size_t(grid.width) +
                   size_t(std::clamp(x, 0, grid.width - 1))) *
                      size_t(channels) +
                  size_t(c)];
  };
  Structure out{grid, {}, {}};
  for (int y = 0; y < grid.height; y++)
    for (int x = 0; x < grid.width; x++) {
      float value = 0, edge = 0;
      for (int c = 0; c < colours; c++) {
        const float v = at(x, y, c), across = at(x + 1, y, c) - at(x - 1, y, c),
                    down = at(x, y + 1, c) - at(x, y - 1, c);
        value += !is_normal ? v : c < 2 ? (v - 0.5f) * (v - 0.5f) : 0;
        edge += across * across + down * down;
      }
      out.values.push_back(is_normal ? std::sqrt(value) : value);
      out.edges.push_back(std::sqrt(edge));
    }
  return out;
}

double agreement(const Structure& a, const Structure& b) {
  double best = 0;
  for (const std::vector<float>* one : {&a.values, &a.edges})
    for (const std::vector<float>* other : {&b.values, &b.edges})
      best = std::max(best, std::abs(correlation(*one, *other)));
  return best;
}

}  // namespace terrazzo
