#include "core/exemplar/elements.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

#include "core/numeric/distance_transform.h"
#include "core/numeric/watershed.h"

namespace terrazzo {

int whole_elements(const Elements& elements, bool wraps) {
  if (wraps) return elements.count;
  std::set<uint16_t> cut;
  const auto width = size_t(elements.size.width), height = size_t(elements.size.height);
  for (size_t x = 0; x < width; x++) cut.insert({elements.at[x], elements.at[(height - 1) * width + x]});
  for (size_t y = 0; y < height; y++) cut.insert({elements.at[y * width], elements.at[y * width + width - 1]});
  return elements.count - int(cut.size());
}

double typical_side(const Elements& elements) {
  std::vector<int64_t> areas(size_t(elements.count));
  for (const uint16_t e : elements.at) areas[e]++;
  double squares = 0;
  for (const int64_t a : areas) squares += double(a) * double(a);
  return std::sqrt(squares / double(elements.at.size()));
}

double joints_in_step(const Elements& elements, const Lattice& lattice, bool wraps) {
  if (lattice.rank != 2) return 0;
  const Size size = elements.size;
  const std::vector<uint8_t> joints = border_pixels(elements.at, size, wraps);
  const std::vector<int64_t> squared = squared_distances(joints, size, wraps);
  const double near = std::max(1.5, typical_side(elements) / 16);
  const auto is_near = [&](size_t i) { return double(squared[i]) <= near * near; };
  const int margin = int(std::ceil(near));  // a joint along the border is no border between regions
  double least = 1;
  for (const Vector2d& step : {lattice.first, lattice.second}) {
    const int dx = int(std::floor(step.x() + 0.5)), dy = int(std::floor(step.y() + 0.5));
    int64_t all = 0, again = 0, pixels = 0, chance = 0;
    for (int y = 0; y < size.height; y++)
      for (int x = 0; x < size.width; x++) {
        int u = x + dx, v = y + dy;
        if (wraps)
          u = wrap(u, size.width), v = wrap(v, size.height);
        else if (u < margin || v < margin || u >= size.width - margin || v >= size.height - margin)
          continue;
        const size_t to = size_t(v) * size_t(size.width) + size_t(u);
        pixels++;
        chance += is_near(to);
        if (!joints[size_t(y) * size_t(size.width) + size_t(x)]) continue;
        all++;
        again += is_near(to);
      }
    if (all == 0 || chance == pixels) return 0;  // nothing is told where all pixels are near a joint
    const double by_chance = double(chance) / double(pixels), share = double(again) / double(all);
    least = std::min(least, (share - by_chance) / (1 - by_chance));
  }
  return std::max(0.0, least);
}

}  // namespace terrazzo
