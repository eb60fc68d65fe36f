#include "core/analysis/repeats/seen_map.h"

#include <algorithm>
#include <cmath>

#include "core/image/image_ops.h"

namespace terrazzo {

bool SeenMap::counts_all(int x, int y, int side) const {
  if (counts.empty()) return true;
  const auto width = size_t(image->width());
  for (int dy = 0; dy < side; dy++)
    for (int dx = 0; dx < side; dx++)
      if (!counts[size_t(wrap(y + dy, image->height())) * width + size_t(wrap(x + dx, image->width()))]) return false;
  return true;
}

std::vector<SeenMap> seen_maps(const Material& material, const ImagePtr& mask, int smallest, const Task& task) {
  std::vector<SeenMap> out;
  for (const Map& map : material.maps()) {
    const Size size = map.image->size();
    if (std::min(size.width, size.height) < smallest) return {};
    out.push_back({materialized(map.image, task)});
    SeenMap& seen = out.back();
    if (!mask) continue;
    seen.counts.reserve(size_t(size.area()));
    for_each_strip(*nearest_at_size(mask, size), [&](const Rect& r, const float* v) {
      for (int64_t i = 0; i < r.area(); i++) seen.counts.push_back(v[i * mask->channels()] > 0.5f);
    });
  }
  return out;
}

PixelLine line_of(const SeenMap& map, bool rows, int i) {
  const Size size = map.image->size();
  const int at = wrap(i, map.lines(rows)), length = map.lines(!rows);
  PixelLine out{map.image->read(rows ? Rect{0, at, size.width, 1} : Rect{at, 0, 1, size.height}), {}};
  out.counts.reserve(size_t(length));
  for (int k = 0; k < length; k++)
    out.counts.push_back(map.counts.empty() ||
                         map.counts[size_t(rows ? at : k) * size_t(size.width) + size_t(rows ? k : at)]);
  return out;
}

LineStep step_between(const PixelLine& a, const PixelLine& b) {
  const size_t pixels = a.counts.size(), channels = a.values.size() / pixels;
  double sum = 0;
  size_t counted = 0;
  for (size_t i = 0; i < pixels; i++) {
    if (!a.counts[i] || !b.counts[i]) continue;
    counted++;
    for (size_t k = i * channels; k < (i + 1) * channels; k++) sum += std::abs(double(a.values[k]) - b.values[k]);
  }
  const double seen = double(counted) / double(pixels);
  return {counted > 0 ? sum / seen : 0, seen};
}

LineStep step_at(const SeenMap& map, bool rows, int i) {
  return step_between(line_of(map, rows, i - 1), line_of(map, rows, i));
}

}  // namespace terrazzo
