#include "core/filter/exemplar_faults.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <vector>

#include "core/numeric/eigen.h"

namespace terrazzo {

namespace {

constexpr int blocks = 8;            // per side: large enough to average out a texture, small enough to see a trend
constexpr double steps = 255.0 / 5;  // colours within 2/255 of each other fall into one cell

/// How often each colour occurs, and the brightness of blocks.
class Look {
 public:
  explicit Look(const Image& image)
      : image_(image), colours_(std::min(image.channels(), LoneFeatureSearch::channels)), lone_(image.size()) {
    for_each_strip(image, [&](const Rect& r, const float* v) {
      for (int y = r.y; y < r.bottom(); y++)
        for (int x = 0; x < r.width; x++, v += image.channels()) add(x, y, v);
    });
  }

  LoneFeature lone() const { return lone_.find(); }

  double one_colour() const {
    int64_t most = 0;
    for (const auto& [colour, count] : counts_) most = std::max(most, count);
    return double(most) / double(image_.size().area());
  }

  /// Mean brightness of each block, row by row.
  std::array<double, blocks * blocks> means() const {
    std::array<double, blocks * blocks> out{};
    for (size_t i = 0; i < out.size(); i++) out[i] = pixels_[i] > 0 ? sums_[i] / double(pixels_[i]) : 0;
    return out;
  }

 private:
  void add(int x, int y, const float* v) {
    std::array<int, 3> colour{};
    std::array<double, LoneFeatureSearch::channels> values{};
    double brightness = 0;
    for (int c = 0; c < colours_; c++) {
      const double value = values[c] = std::max(0.0, std::min(1.0, double(v[c])));  // 1 for what is no number
      colour[c] = int(value * steps + 0.5);
      brightness += value / colours_;
    }
    if (last_ == counts_.end() || last_->first != colour) last_ = counts_.try_emplace(colour, 0).first;
    last_->second++;
    lone_.add(x, y, values.data());
    const size_t block = size_t(int64_t{y} * blocks / image_.height() * blocks + int64_t{x} * blocks / image_.width());
    sums_[block] += brightness;
    pixels_[block]++;
  }

  const Image& image_;
  const int colours_;
  LoneFeatureSearch lone_;
  std::map<std::array<int, 3>, int64_t> counts_;
  std::map<std::array<int, 3>, int64_t>::iterator last_ = counts_.end();
  std::array<double, blocks * blocks> sums_{};
  std::array<int64_t, blocks * blocks> pixels_{};
};

}  // namespace

ExemplarFaults exemplar_faults(const Image& image) {
  ExemplarFaults out;
  if (std::min(image.width(), image.height()) < blocks) return out;
  const Look look(image);
  out.one_colour = look.one_colour();
  out.lone = look.lone();
  const auto means = look.means();
  // A plane through the means, by least squares: the columns of x, y and 1 are orthogonal.
  Eigen::Vector3d plane = Eigen::Vector3d::Zero();
  const auto at = [](int i) { return 2.0 * i / (blocks - 1) - 1; };
  double squares = 0;
  for (int i = 0; i < blocks; i++) squares += at(i) * at(i) * blocks;
  for (int y = 0; y < blocks; y++)
    for (int x = 0; x < blocks; x++)
      plane +=
          means[size_t(y) * blocks + x] * Eigen::Vector3d(at(x) / squares, at(y) / squares, 1.0 / (blocks * blocks));
  const bool is_across = std::abs(plane[0]) >= std::abs(plane[1]);
  const double slope = is_across ? plane[0] : plane[1], dark = plane[2] - std::abs(slope);
  if (dark <= 0) return out;
  out.brightening = 2 * std::abs(slope) / dark;
  double residual = 0;
  for (int y = 0; y < blocks; y++)
    for (int x = 0; x < blocks; x++) {
      const double expected = plane[0] * at(x) + plane[1] * at(y) + plane[2];
      residual += (means[size_t(y) * blocks + x] - expected) * (means[size_t(y) * blocks + x] - expected);
    }
  out.unevenness = std::sqrt(residual / (blocks * blocks)) / dark;
  constexpr std::array<std::string_view, 4> sides = {"right", "left", "bottom", "top"};
  const int side = (is_across ? 0 : 2) + (slope > 0 ? 0 : 1);
  out.bright_side = sides[side];
  out.dark_side = sides[side ^ 1];
  return out;
}

}  // namespace terrazzo
