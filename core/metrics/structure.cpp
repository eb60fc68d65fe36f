#include "core/metrics/structure.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <vector>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "core/base/tuning.h"
#include "core/metrics/patches.h"
#include "core/numeric/nearest.h"

namespace terrazzo {

namespace {

constexpr uint64_t structure_seed = 7;
constexpr double usual = 0.95;  ///< share of the exemplar's windows that are not foreign to it
constexpr float slightest_edge = 1e-6f;

struct StructureTuning {
  double edge_scale = 0.35;
  double smoothing = 0.5;
  double slack = 0.1;
  int pool = 60000;
  int queries = 2000;
  int eights_of_dimensions = 3;
};
const Tunable<StructureTuning> structure_tuning(
    "structure",
    {
        {&StructureTuning::edge_scale, "edge_scale", "steps",
         "deviation of the Gaussian under which edges are seen. Higher: grain has no say; lower: fine joints have",
         "structure", 0.1, 4},
        {&StructureTuning::smoothing, "smoothing", "steps",
         "deviation of the Gaussian by which the tensor is smoothed. Higher: edges may lie a bit elsewhere; lower: "
         "they must lie where they did",
         "structure", 0, 4},
        {&StructureTuning::slack, "slack", "share of a distance",
         "by which the nearest window may be missed. Higher: less time", "not measured: as patch_statistics.slack"},
        {&StructureTuning::pool, "pool", "windows",
         "of the exemplar among which the nearest is looked for. Higher: copies are found exactly; costs time",
         "not measured: all windows of 512x512 where elements are larger than 56 pixels, nearly", 2},
        {&StructureTuning::queries, "queries", "windows", "for which it is. Higher: the figure varies less; costs time",
         "not measured: a share of 0.05 varies by 0.005", 1},
        {&StructureTuning::eights_of_dimensions, "eights_of_dimensions", "eight components",
         "of a window in which it is. Higher: fine detail has a say; costs time", "structure", 1, 6},
    });

/// The structure tensor's three entries.
Planes structure_tensor(const Planes& image, int step, const Task& task) {
  const Beyond beyond = around_or_mirrored(image);
  const Planes smooth = blurred(image, structure_tuning->edge_scale * std::max(2, step), beyond, task);
  Planes out = Planes::zeros(image.size, 3, image.wraps);
  tbb::parallel_for(0, image.size.height, [&](int y) {
    for (int x = 0; x < image.size.width; x++) {
      const float *left = smooth.at(smooth.column(x - 1), y), *right = smooth.at(smooth.column(x + 1), y);
      const float *above = smooth.at(x, smooth.row(y - 1)), *below = smooth.at(x, smooth.row(y + 1));
      float* to = out.at(x, y);
      for (int c = 0; c < image.channels; c++) {
        const float across = right[c] - left[c], down = below[c] - above[c];
        to[0] += across * across;
        to[1] += across * down;
        to[2] += down * down;
      }
    }
  });
  return blurred(out, structure_tuning->smoothing * step, beyond, task);
}

/// Without the border, where the tensor depends on pixels outside the image; unchanged if two windows would not fit.
Planes inner(const Planes& image, int step) {
  const int side = std::min(image.size.width, image.size.height);
  const int margin = std::clamp((side - (2 * patch_side + 1) * step) / 2, 0, 2 * step + 1);
  Planes out = Planes::zeros({image.size.width - 2 * margin, image.size.height - 2 * margin}, image.channels);
  for (int y = 0; y < out.size.height; y++)
    std::copy_n(image.at(margin, margin + y), size_t(out.size.width) * image.channels, out.at(0, y));
  return out;
}

/// The root mean square of the edge strength; an edge of this strength counts half.
float usual_strength(const Planes& tensor) {
  double sum = 0;
  for (size_t i = 0; i < tensor.values.size(); i += 3) sum += double(tensor.values[i]) + double(tensor.values[i + 2]);
  return float(std::sqrt(sum / double(tensor.size.area()))) + slightest_edge;
}

/// Strength, and strength times the cosine and the sine of twice the angle, scaled by how well the edges agree on one.
Planes edge_channels(Planes tensor, float half) {
  for (size_t i = 0; i < tensor.values.size(); i += 3) {
    float* v = &tensor.values[i];
    const float energy = v[0] + v[2], difference = v[0] - v[2], product = 2 * v[1];
    const float strength = std::sqrt(energy), seen = strength / (strength + half);
    const float share = seen / (energy + slightest_edge * half * half);
    v[0] = seen;
    v[1] = difference * share;
    v[2] = product * share;
  }
  return tensor;
}

/// The exemplar's windows, searched for nearest neighbours.
class ExemplarWindows {
 public:
  ExemplarWindows(const Planes& edges, int step, const Task& task)
      : step_(step), task_(task), period_(edges.wraps ? edges.size : Size{}) {
    const Planes image = edges.wraps ? with_windows_across(edges, step) : inner(edges, step);
    across_ = patch_positions(image.size, step).width;
    patches_ = random_patches(image.size, size_t(structure_tuning->pool), structure_seed, step);
    space_ = principal_projection(image, patches_, 8 * structure_tuning->eights_of_dimensions, task, step);
    points_ = project(image, patches_, space_, task);
    tree_ = std::make_unique<NearestPoints>(points_, space_.outputs);
  }

  /// Sorted distances of the first windows to the nearest ones that do not overlap them.
  std::vector<double> own_distances() const {
    std::vector<double> out = distances(points_, true);
    std::ranges::sort(out);
    while (!out.empty() && !std::isfinite(out.back())) out.pop_back();
    return out;
  }

  /// Distances of windows at random places; in an image as large as the exemplar, at the places of the exemplar's.
  std::vector<double> distances_of(const Planes& edges, Size exemplar) const {
    const uint64_t seed = edges.size == exemplar ? structure_seed : 8;
    const Planes image = inner(edges, step_);
    const PatchList windows = random_patches(image.size, size_t(structure_tuning->queries), seed, step_);
    return distances(project(image, windows, space_, task_), false);
  }

 private:
  bool overlap(uint32_t a, uint32_t b) const {
    const auto near = [&](uint32_t p, uint32_t q, int period) {
      int apart = std::abs(int(p) - int(q));
      if (period > 0) apart = std::min(apart, period - apart);
      return apart < patch_side * step_;
    };
    const auto width = uint32_t(across_);
    return near(a % width, b % width, period_.width) && near(a / width, b / width, period_.height);
  }

  std::vector<double> distances(const std::vector<float>& points, bool own) const {
    const auto dimensions = size_t(space_.outputs);
    const double slack = structure_tuning->slack;
    std::vector<double> out(std::min(size_t(structure_tuning->queries), points.size() / dimensions));
    tbb::parallel_for(tbb::blocked_range<size_t>(0, out.size(), 64), [&](const auto& range) {
      task_.check();
      for (size_t i = range.begin(); i < range.end(); i++) {
        const auto too_near = [&](uint32_t other) { return own && overlap(patches_[i], patches_[other]); };
        const NearestPoints::Match found = tree_->find(&points[i * dimensions], slack, too_near);
        out[i] = found.index == NearestPoints::nothing ? HUGE_VAL : std::sqrt(double(found.squared));
      }
    });
    return out;
  }

  int step_;
  const Task& task_;
  Size period_;
  int across_ = 0;
  PatchList patches_;
  Projection space_;
  std::vector<float> points_;
  std::unique_ptr<NearestPoints> tree_;
};

}  // namespace

int StructureWindow::side() const {
  return (patch_side * step) << level;
}

StructureWindow structure_window(double element, Size exemplar) {
  const double most = std::min(element / 2, std::min(exemplar.width, exemplar.height) / 4.0);
  StructureWindow out;
  for (int level = 0; level < 12; level++)
    for (int step = level > 0 ? 2 : 1; step <= 3; step++)
      if (const StructureWindow w{level, step}; w.side() <= most) out = w;
  return out;
}

double foreign_structure(const Planes& exemplar, const Planes& output, int step, const Task& task) {
  Planes tensor = structure_tensor(exemplar, step, task);
  const float half = usual_strength(tensor);
  const ExemplarWindows windows(edge_channels(std::move(tensor), half), step, task);
  const std::vector<double> own = windows.own_distances();
  if (own.empty()) return 0;
  const double limit = own[size_t(usual * double(own.size() - 1))];
  task.check();
  const std::vector<double> far =
      windows.distances_of(edge_channels(structure_tensor(output, step, task), half), exemplar.size);
  return double(std::ranges::count_if(far, [&](double d) { return d > limit; })) / double(far.size());
}

}  // namespace terrazzo
