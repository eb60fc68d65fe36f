#include "core/stochastic/stochastic_exemplar.h"

#include <algorithm>
#include <cmath>

#include <tbb/parallel_for.h>

#include "core/base/error.h"
#include "core/base/hash.h"
#include "core/image/image_ops.h"
#include "core/numeric/linear_algebra.h"
#include "core/numeric/moments.h"
#include "core/stochastic/blending_space.h"

namespace terrazzo {

namespace {

/// Components that vary less than this part of a channel's variance hold nothing but rounding.
constexpr double least_variance = 1e-9;
/// Pixels a side of the sample that tells how blending changes histograms.
constexpr int measured_side = 256;

/// The channels of one row of all maps, interleaved.
void read_row(const std::vector<ImagePtr>& maps, int y, int channels, float* out) {
  int first = 0;
  for (const ImagePtr& map : maps) {
    const std::vector<float> row = map->read({0, y, map->width(), 1});
    const int count = map->channels();
    for (int x = 0; x < map->width(); x++)
      std::copy_n(&row[size_t(x) * count], count, out + size_t(x) * channels + first);
    first += count;
  }
}

/// One channel of interleaved values, as an image.
ImagePtr plane_image(const Planes& planes, int channel) {
  std::vector<float> values(size_t(planes.size.area()));
  for (size_t i = 0; i < values.size(); i++) values[i] = planes.values[i * planes.channels + channel];
  return Image::from_floats({.size = planes.size}, std::move(values));
}

}  // namespace

StochasticExemplar::Places StochasticExemplar::places(int length, int reach, bool wraps) {
  if (wraps) return {0, length};
  const int count = length - 2 * reach;
  return count > 0 ? Places{reach, count} : Places{(length - 1) / 2, 1};
}

StochasticExemplar::StochasticExemplar(const Material& exemplar, bool wraps, int cell, const Task& task) {
  const TriangleGrid grid(cell, {}, 0);
  components_.size = exemplar.size();
  components_.wraps = wraps;
  x_ = places(size().width, grid.reach_x(), wraps);
  y_ = places(size().height, grid.reach_y(), wraps);
  int channels = 0;
  std::vector<ImagePtr> maps;
  for (const Map& m : exemplar.maps()) {
    first_channels_.push_back(channels);
    if (!blends_samples(m.image->info())) continue;
    maps.push_back(in_blending_space(nearest_at_size(m.image, size())));
    channels += m.image->channels();
  }
  means_.resize(size_t(channels));
  deviations_.resize(size_t(channels));
  if (channels == 0) return;
  measure(maps, task);
  decorrelate(maps, task);
  gaussianise(task);
  restore_histograms(maps, grid, task);
}

/// Finds means and deviations, and from correlations the components.
void StochasticExemplar::measure(const std::vector<ImagePtr>& maps, const Task& task) {
  const int n = channels();
  std::vector<float> row(size_t(size().width) * n);
  // Heights may lie far from 0: taken from the first pixel they stay exact.
  std::vector<double> start, values(size_t(n), 0.0);
  Moments<> moments(n);
  for (int y = 0; y < size().height; y++) {
    task.check();
    read_row(maps, y, n, row.data());
    if (y == 0) start.assign(row.begin(), row.begin() + n);
    for (int x = 0; x < size().width; x++) {
      for (int c = 0; c < n; c++) values[c] = double(row[size_t(x) * n + c]) - start[c];
      moments.add(values.data());
    }
  }
  MatrixXd correlations = MatrixXd::Zero(n, n);
  for (int c = 0; c < n; c++) {
    means_[c] = start[c] + moments.mean(c);
    if (!std::isfinite(means_[c])) throw Error("material", "the maps hold infinite or NaN values");
    deviations_[c] = std::sqrt(moments.variance(c));
  }
  for (int i = 0; i < n; i++)
    for (int j = 0; j < n; j++)
      if (const double both = deviations_[i] * deviations_[j]; both != 0)
        correlations(i, j) = moments.covariance(i, j) / both;
  const SymmetricEigen eigen = eigen_symmetric(correlations);
  const auto kept = std::ranges::count_if(eigen.values, [](double v) { return v > least_variance; });
  axes_ = eigen.vectors.leftCols(kept);
}

void StochasticExemplar::decorrelate(const std::vector<ImagePtr>& maps, const Task& task) {
  const int n = channels(), count = int(axes_.cols());
  components_.channels = count;
  components_.values.resize(size_t(size().area()) * count);
  tbb::parallel_for(0, size().height, [&](int y) {
    const CurrentTask scope(task);
    std::vector<float> row(size_t(size().width) * n);
    read_row(maps, y, n, row.data());
    VectorXd pixel(n);
    for (int x = 0; x < size().width; x++) {
      for (int c = 0; c < n; c++)
        pixel[c] = deviations_[c] > 0 ? (double(row[size_t(x) * n + c]) - means_[c]) / deviations_[c] : 0;
      for (int k = 0; k < count; k++) components_.at(x, y)[k] = float(axes_.col(k).dot(pixel));
    }
  });
}

void StochasticExemplar::gaussianise(const Task& task) {
  const int count = components_.channels;
  for (int k = 0; k < count; k++)
    transforms_.emplace_back(Distribution::of(*plane_image(components_, k), task).front());
  tbb::parallel_for(0, size().height, [&](int y) {
    task.check();
    for (int x = 0; x < size().width; x++)
      for (int k = 0; k < count; k++) {
        float& v = components_.at(x, y)[k];
        v = float(transforms_[k].to_gaussian(v));
      }
  });
}

/// Components that are independent of one another no longer are what they were together: blends spread over scattered
/// places tell what has become of the channels.
void StochasticExemplar::restore_histograms(const std::vector<ImagePtr>& maps, const TriangleGrid& grid,
                                            const Task& task) {
  const int n = channels();
  Planes blends = Planes::zeros({measured_side, measured_side}, n);
  tbb::parallel_for(0, measured_side, [&](int y) {
    task.check();
    std::vector<double> pixel(size_t(n), 0.0);
    for (int x = 0; x < measured_side; x++) {
      const uint64_t bits = random_bits(0, x, y);
      blend_raw(grid.around(int64_t(bits & 0xffffff), int64_t(bits >> 40)), 0, n, pixel.data());
      std::ranges::copy(pixel, blends.at(x, y));
    }
  });
  for (const ImagePtr& map : maps)
    for (const Distribution& wanted : Distribution::of(*map, task)) {
      const ImagePtr found = plane_image(blends, int(restoring_.size()));
      restoring_.push_back(restoring_curve(Distribution::of(*found, task).front(), wanted));
    }
}

size_t StochasticExemplar::sample(const GridVertex& v) const {
  const auto low = uint32_t(v.bits), high = uint32_t(v.bits >> 32);
  const int x = components_.column(x_.first + int(below(low, uint32_t(x_.count))) + v.dx);
  const int y = components_.row(y_.first + int(below(high, uint32_t(y_.count))) + v.dy);
  return size_t(y) * size().width + size_t(x);
}

void StochasticExemplar::blend_raw(const std::array<GridVertex, 3>& vertices, int first, int count, double* out) const {
  const int components = components_.channels;
  std::array<const float*, 3> samples{};
  for (size_t i = 0; i < 3; i++) samples[i] = components_.values.data() + sample(vertices[i]) * components;
  std::fill_n(out, count, 0.0);
  for (int k = 0; k < components; k++) {
    double gaussian = 0;
    for (size_t i = 0; i < 3; i++) gaussian += vertices[i].weight * double(samples[i][k]);
    const double value = transforms_[k].to_value(gaussian);
    for (int c = 0; c < count; c++) out[c] += axes_(first + c, k) * value;
  }
  for (int c = 0; c < count; c++) out[c] = means_[first + c] + deviations_[first + c] * out[c];
}

void StochasticExemplar::blend(const std::array<GridVertex, 3>& vertices, int first, int count, float* out) const {
  std::array<double, 4> values{};
  blend_raw(vertices, first, count, values.data());
  for (int c = 0; c < count; c++) out[c] = float(restoring_[first + c](values[c]));
}

}  // namespace terrazzo
