#include "core/analysis/progression.h"

#include <tbb/parallel_for.h>

#include "core/analysis/principal_components.h"
#include "core/analysis/smoothing.h"
#include "core/distribution.h"

namespace terrazzo {

namespace {

/// The planes' values along their leading principal component.
std::vector<float> leading_component(const ExemplarPlanes& planes, const Task& task) {
  const int n = planes.channels;
  const std::vector<float> axis = principal_components(planes.values, n, 1, task).components;
  const double sign = axis.front() < 0 ? -1 : 1;
  std::vector<float> out(size_t(planes.size.area()));
  tbb::parallel_for(0, planes.size.height, [&](int y) {
    for (int x = 0; x < planes.size.width; x++) {
      double sum = 0;
      for (int c = 0; c < n; c++) sum += double(axis[c]) * double(planes.at(x, y)[c]);
      out[size_t(y) * planes.size.width + x] = float(sign * sum);
    }
  });
  return out;
}

/// From values to ranks, stretched so that the least is 0 and the greatest 1.
Curve equalizing_curve(const Distribution& d, bool inverted) {
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
  const ExemplarPlanes planes = box_smoothed(weighted_planes(features, task), deviation, task);
  const ImageInfo info{.size = features.size(), .channels = 1, .semantic = Semantic::guidance, .depth = Depth::u16};
  std::vector<float> values = leading_component(planes, task);
  const Curve curve = equalizing_curve(Distribution::of(*Image::from_floats(info, values), task).front(), inverted);
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
