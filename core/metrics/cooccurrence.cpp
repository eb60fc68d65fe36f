#include "core/metrics/cooccurrence.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include <tbb/parallel_for.h>

#include "core/numeric/linear_algebra.h"

namespace terrazzo {

namespace {

constexpr int depth = 4;
constexpr int classes = 1 << depth;
constexpr std::array<int, 4> distances = {1, 2, 4, 8};
constexpr std::array<std::array<int, 2>, 4> directions = {{{1, 0}, {0, 1}, {1, 1}, {-1, 1}}};

/// Projects pixels onto the principal axes of the exemplar's colours.
class Turned {
 public:
  explicit Turned(const Planes& exemplar) {
    const Moments<> moments = channel_moments(exemplar);
    mean_ = moments.mean_vector();
    axes_ = eigen_symmetric(moments.covariance_matrix()).vectors.transpose();
  }
  Planes operator()(const Planes& image) const {
    Planes out = Planes::zeros(image.size, image.channels);
    const int n = image.channels;
    for (size_t i = 0; i < image.values.size(); i += size_t(n)) {
      const VectorXd from_mean = Eigen::Map<const Eigen::VectorXf>(&image.values[i], n).cast<double>() - mean_;
      Eigen::Map<Eigen::VectorXf>(&out.values[i], n) = (axes_ * from_mean).cast<float>();
    }
    return out;
  }

 private:
  VectorXd mean_;
  MatrixXd axes_;  ///< a row for each
};

/// A median cut (Heckbert 1982): splits along the axis of greatest spread into halves of equally many pixels.
class MedianCut {
 public:
  explicit MedianCut(const Planes& pixels) : splits_(classes) {
    std::vector<uint32_t> all(size_t(pixels.size.area()));
    std::iota(all.begin(), all.end(), 0u);
    split(pixels, all.data(), all.data() + all.size(), 1);
  }
  uint8_t classify(const float* pixel) const {
    int node = 1;
    while (node < classes) node = 2 * node + (pixel[splits_[node].axis] > splits_[node].last ? 1 : 0);
    return uint8_t(node - classes);
  }

 private:
  struct Split {
    int axis = 0;
    float last = 0;  ///< the largest value of the lower half
  };

  void split(const Planes& pixels, uint32_t* begin, uint32_t* end, int node) {
    if (node >= classes || begin == end) return;
    const int c = pixels.channels;
    double widest = -1;
    int axis = 0;
    for (int k = 0; k < c; k++) {
      Moments<1> spread;
      for (const uint32_t* i = begin; i < end; i++) spread.add(double(pixels.values[size_t(*i) * c + k]));
      if (spread.variance() > widest) {
        widest = spread.variance();
        axis = k;
      }
    }
    const auto value = [&](uint32_t i) { return pixels.values[size_t(i) * c + axis]; };
    uint32_t* middle = begin + (end - begin - 1) / 2;
    std::nth_element(begin, middle, end, [&](uint32_t a, uint32_t b) { return value(a) < value(b); });
    const float last = value(*middle);
    splits_[node] = {axis, last};
    uint32_t* upper = std::partition(begin, end, [&](uint32_t i) { return value(i) <= last; });
    split(pixels, begin, upper, 2 * node);
    split(pixels, upper, end, 2 * node + 1);
  }

  std::vector<Split> splits_;  ///< a heap: node i has children 2i and 2i + 1; from `classes` on they are leaves
};

using Table = std::array<double, classes * classes>;

Table pair_table(const std::vector<uint8_t>& labels, Size size, int dx, int dy) {
  std::array<int64_t, classes * classes> counts{};
  int64_t pairs = 0;
  const int first = std::max(0, -dx), last = std::min(size.width, size.width - dx);
  for (int y = 0; y + dy < size.height; y++)
    for (int x = first; x < last; x++, pairs++)
      counts[labels[size_t(y) * size.width + x] * classes + labels[size_t(y + dy) * size.width + x + dx]]++;
  Table out{};
  for (size_t i = 0; i < out.size() && pairs > 0; i++) out[i] = double(counts[i]) / double(pairs);
  return out;
}

std::vector<uint8_t> classified(const Planes& image, const MedianCut& cut) {
  std::vector<uint8_t> out(size_t(image.size.area()));
  for (size_t i = 0; i < out.size(); i++) out[i] = cut.classify(&image.values[i * image.channels]);
  return out;
}

}  // namespace

double cooccurrence_distance(const Planes& exemplar, const Planes& output, const Task& task) {
  const Turned turned(exemplar);
  const Planes e = turned(exemplar), o = turned(output);
  const MedianCut cut(e);
  const std::vector<uint8_t> a = classified(e, cut), b = classified(o, cut);
  std::array<double, distances.size() * directions.size()> difference{};
  tbb::parallel_for(size_t{0}, difference.size(), [&](size_t i) {
    task.check();
    const int step = distances[i / directions.size()];
    const auto [x, y] = directions[i % directions.size()];
    const Table p = pair_table(a, e.size, x * step, y * step), q = pair_table(b, o.size, x * step, y * step);
    for (size_t k = 0; k < p.size(); k++) difference[i] += std::abs(p[k] - q[k]) / 2;
  });
  double sum = 0;
  for (const double d : difference) sum += d;
  return sum / double(difference.size());
}

}  // namespace terrazzo
