#include "core/resolve/slow_tones.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/tuning.h"
#include "core/filter/resample.h"
#include "core/image/pixel_space.h"
#include "core/numeric/box_filter.h"

namespace terrazzo {

namespace {

struct SlowTonesTuning {
  double least_slow = 0.6;
};
const Tunable<SlowTonesTuning> slow_tones_tuning(
    "slow_tones", {{&SlowTonesTuning::least_slow, "least_slow", "share of the variance",
                    "higher: only tones that are very smooth are joined; lower: colours of bricks and stones run into "
                    "one another",
                    "slow_tones", 0, 1}});

constexpr int cells_per_reach = 4;       ///< tones are blurred by half of that: finer cells show the same
constexpr double flat_variance = 1e-10;  ///< of tones; floats differ by as much where a map is flat
constexpr int passes = 3;                ///< of a box, for a Gaussian

std::vector<float> blurred(std::vector<float> values, Size size, int channels, double sigma, bool wraps,
                           const Task& task) {
  box_filter(values, size, channels, Box::of_variance(sigma * sigma / passes), passes, wraps, task);
  return values;
}

/// Of all channels together.
double variance(const std::vector<float>& values, int channels) {
  double sum = 0;
  const auto count = double(values.size()) / channels;
  for (int c = 0; c < channels; c++) {
    double mean = 0, squares = 0;
    for (size_t i = size_t(c); i < values.size(); i += size_t(channels)) mean += values[i] / count;
    for (size_t i = size_t(c); i < values.size(); i += size_t(channels))
      squares += (values[i] - mean) * (values[i] - mean) / count;
    sum += squares;
  }
  return sum;
}

}  // namespace

/// Four cells and their weights.
struct SlowTones::Place {
  std::array<size_t, 4> cells;
  std::array<float, 4> weights;
};

bool SlowTones::exist_in(const ImageInfo& info) {
  switch (info.semantic) {
    case Semantic::base_color:
    case Semantic::normal:
    case Semantic::roughness:
    case Semantic::metallic:
    case Semantic::ambient_occlusion:
    case Semantic::emission:
    case Semantic::specular:
      return true;
    default:
      return false;
  }
}

SlowTones::SlowTones(const ImagePtr& map, Size exemplar, double reach, bool wraps, const Task& task)
    : reach_(reach), wraps_(wraps), channels_(value_channels(map->info())) {
  const double cell = std::max(1.0, reach / cells_per_reach);
  size_ = {std::max(1, int(exemplar.width / cell + 0.5)), std::max(1, int(exemplar.height / cell + 0.5))};
  cells_per_pixel_x_ = double(size_.width) / exemplar.width;
  cells_per_pixel_y_ = double(size_.height) / exemplar.height;
  const ImagePtr cells = numbers_at_size(map, size_, task);
  const float* values = cells->in_memory();
  const int stored = cells->channels();
  for (int64_t i = 0; i < size_.area(); i++)
    for (int c = 0; c < channels_; c++) {
      const float v = values[i * stored + c];
      tones_.push_back(std::isfinite(v) ? v : 0);
    }
  const double in_cells = reach / cell;
  tones_ = blurred(std::move(tones_), size_, channels_, in_cells / 2, wraps, task);

  // Around their mean, so that floats hold the small differences of squares.
  std::vector<float> squares(tones_.size());
  std::vector<double> mean(size_t(channels_), 0.0);
  for (size_t i = 0; i < tones_.size(); i++) mean[i % size_t(channels_)] += double(tones_[i]) / double(size_.area());
  std::vector<float> centred(tones_.size());
  for (size_t i = 0; i < tones_.size(); i++) {
    centred[i] = float(tones_[i] - mean[i % size_t(channels_)]);
    squares[i] = centred[i] * centred[i];
  }
  const std::vector<float> means = blurred(std::move(centred), size_, channels_, in_cells, wraps, task);
  squares = blurred(std::move(squares), size_, channels_, in_cells, wraps, task);
  double nearby = 0;
  for (int64_t i = 0; i < size_.area(); i++) {
    float sum = 0;
    for (int c = 0; c < channels_; c++) {
      const auto at = size_t(i * channels_ + c);
      sum += std::max(0.0f, squares[at] - means[at] * means[at]);
    }
    spread_.push_back(std::sqrt(sum));
    nearby += double(sum) / double(size_.area());
  }
  const double all = variance(tones_, channels_);
  slow_share_ = all > flat_variance ? std::clamp(1 - nearby / all, 0.0, 1.0) : 0;
}

bool SlowTones::are_slow() const {
  return slow_share_ >= slow_tones_tuning->least_slow;
}

SlowTones::Place SlowTones::place(double x, double y) const {
  const auto along = [this](double at, int count, std::array<int, 2>& cells) {
    const double down = std::floor(at);
    for (int i = 0; i < 2; i++)
      cells[size_t(i)] = wraps_ ? wrap(int(down) + i, count) : std::clamp(int(down) + i, 0, count - 1);
    return float(at - down);
  };
  std::array<int, 2> columns, rows;
  const float right = along((x + 0.5) * cells_per_pixel_x_ - 0.5, size_.width, columns);
  const float below = along((y + 0.5) * cells_per_pixel_y_ - 0.5, size_.height, rows);
  const auto cell = [&](int i, int j) {
    return size_t(rows[size_t(j)]) * size_t(size_.width) + size_t(columns[size_t(i)]);
  };
  return {{cell(0, 0), cell(1, 0), cell(0, 1), cell(1, 1)},
          {(1 - right) * (1 - below), right * (1 - below), (1 - right) * below, right * below}};
}

void SlowTones::add(double x, double y, float weight, float* sum) const {
  const Place p = place(x, y);
  for (size_t i = 0; i < 4; i++) {
    const float* tone = &tones_[p.cells[i] * size_t(channels_)];
    for (int c = 0; c < channels_; c++) sum[c] += weight * p.weights[i] * tone[c];
  }
}

float SlowTones::spread(double x, double y) const {
  const Place p = place(x, y);
  float sum = 0;
  for (size_t i = 0; i < 4; i++) sum += p.weights[i] * spread_[p.cells[i]];
  return sum;
}

}  // namespace terrazzo
