#include "core/stochastic/method.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "core/analysis/space/planes.h"
#include "core/base/tuning.h"
#include "core/stochastic/histogram_transform.h"

namespace terrazzo {

namespace {

struct MethodTuning {
  double most_structure = 0.5;
};
const Tunable<MethodTuning> method_tuning(
    "method", {{&MethodTuning::most_structure, "most_structure", "excess kurtosis",
                "of exemplars that noise by example suits. Higher: more exemplars, some of whose features "
                "it tears; lower: fewer",
                "method", 0, 100}});

constexpr int largest_side = 512;  ///< larger exemplars are looked at in half the size, and so on
constexpr int smallest_side = 64;  ///< of a scale; smaller ones have too few pixels to tell
constexpr int scales = 3;

/// The exemplar's leading component with a Gaussian histogram.
Planes gaussian_component(const Features& features, const Task& task) {
  Planes planes = *weighted_planes(features, task);
  while (std::min(planes.size.width, planes.size.height) >= largest_side) planes = halved(planes);
  Planes out{planes.size, 1, false, leading_component(planes, task)};
  const ImagePtr image = Image::from_floats({.size = out.size}, out.values);
  const HistogramTransform transform(Distribution::of(*image, task).front());
  for (float& v : out.values) v = float(transform.to_gaussian(v));
  return out;
}

/// Of numbers whose mean is about 0: 0 if they are Gaussian, or all the same.
double excess_kurtosis(const std::vector<double>& values) {
  double squares = 0, fourths = 0;
  for (const double v : values) {
    squares += v * v;
    fourths += v * v * v * v;
  }
  return squares > 0 ? fourths * double(values.size()) / (squares * squares) - 3 : 0;
}

/// The largest of the excess kurtoses of a scale's band and of its derivatives in four directions.
double structure_of_scale(const Planes& scale, const Task& task) {
  const Planes smooth = blurred(scale, 1, Beyond::mirrored, task);
  constexpr std::array<std::array<int, 2>, 4> directions = {{{1, 0}, {0, 1}, {1, 1}, {1, -1}}};
  double most = 0;
  const auto look = [&](const auto& response) {
    std::vector<double> values;
    for (int y = 1; y < scale.size.height - 1; y++)
      for (int x = 1; x < scale.size.width - 1; x++) values.push_back(response(x, y));
    most = std::max(most, excess_kurtosis(values));
  };
  look([&](int x, int y) { return double(*scale.at(x, y)) - *smooth.at(x, y); });
  for (const auto& [dx, dy] : directions)
    look([&, dx = dx, dy = dy](int x, int y) {
      return double(*smooth.at(x + dx, y + dy)) - *smooth.at(x - dx, y - dy);
    });
  return most;
}

/// A texture that is Gaussian noise on a part p of its area and flat elsewhere has the excess kurtosis 3 / p - 3: the
/// share of such a texture that is flat, 0..1.
double share_of(double excess_kurtosis) {
  const double excess = std::max(0.0, excess_kurtosis);
  return excess / (excess + 3);
}

}  // namespace

std::string MethodChoice::sentence() const {
  return fmt::format("{} suits it: {}", method == Method::noise ? "noise by example" : "a layout", why);
}

double structure(const Features& features, const Task& task) {
  double most = 0;
  for (const Planes& scale : gaussian_pyramid(gaussian_component(features, task), scales, task)) {
    task.check();
    if (std::min(scale.size.width, scale.size.height) >= smallest_side)
      most = std::max(most, structure_of_scale(scale, task));
  }
  return most;
}

MethodChoice suitable_method(const Features& features, const Task& task) {
  if (features.repeats().streaks.any()) return {Method::layout, "it has streaks"};
  if (features.repeats().lattice.rank > 0) return {Method::layout, "it repeats"};
  if (features.elements())
    return {Method::layout, fmt::format("its {} elements stay whole", features.elements()->count)};
  if (std::min(features.size().width, features.size().height) < smallest_side)
    return {Method::layout, "it is too small to tell whether it has structure"};
  const double found = structure(features, task);
  if (found > method_tuning->most_structure)
    return {Method::layout, fmt::format("its features stand out (structure {:.2f} of 1, above {:.2f})", share_of(found),
                                        share_of(method_tuning->most_structure))};
  return {Method::noise,
          fmt::format("it has no lattice, no elements and hardly any structure ({:.2f} of 1, up to {:.2f})",
                      share_of(found), share_of(method_tuning->most_structure))};
}

}  // namespace terrazzo
