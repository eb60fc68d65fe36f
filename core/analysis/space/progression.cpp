#include "core/analysis/space/progression.h"

#include <tbb/parallel_for.h>

#include "core/analysis/space/planes.h"
#include "core/image/distribution.h"

namespace terrazzo {

namespace {

/// From values to ranks, stretched so that the least is 0 and the greatest 1.
PiecewiseLinear equalizing_curve(const Distribution& d, bool inverted) {
  std::vector<double> values, ranks;
  const double low = d.ranks().front(), high = d.ranks().back();
  for (size_t i = 0; i < d.atoms().size(); i++) {
    const double rank = high > low ? (d.ranks()[i] - low) / (high - low) : 0.5;
    values.push_back(d.atoms()[i].value);
    ranks.push_back(inverted ? 1 - rank : rank);
  }
  return {std::move(values), std::move(ranks)};
}

}  // namespace

ImagePtr progression_of(const Features& features, double deviation, bool inverted, const Task& task) {
  const Planes planes = box_blurred(*weighted_planes(features, task), deviation, task);
  const ImageInfo info{.size = features.size(), .channels = 1, .semantic = Semantic::guidance, .depth = Depth::u16};
  std::vector<float> values = leading_component(planes, task);
  const PiecewiseLinear curve =
      equalizing_curve(Distribution::of(*Image::from_floats(info, values), task).front(), inverted);
  const int width = info.size.width;
  tbb::parallel_for(0, info.size.height, [&](int y) {
    for (int x = 0; x < width; x++) {
      float& v = values[size_t(y) * width + x];
      v = float(curve(v));
    }
  });
  return Image::from_floats(info, std::move(values));
}

}  // namespace terrazzo
