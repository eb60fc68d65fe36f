#include "core/exemplar/joint_map.h"

#include <algorithm>
#include <cmath>

#include "core/numeric/distance_transform.h"
#include "core/numeric/watershed.h"

namespace terrazzo {

JointMap::JointMap(const Elements& elements, bool wraps, const Lattice& bands)
    : size_(elements.size),
      wraps_(wraps),
      near_(std::max(1.5, typical_side(elements) / 16)),
      joints_(border_pixels(elements.at, size_, wraps)),
      squared_(squared_distances(joints_, size_, wraps)),
      by_rows_(bands.first.y() != 0) {
  if (bands.rank == 1) near_of_line_ = near_shares(by_rows_);
}

double JointMap::in_step(const Vector2d& step) const {
  const int dx = int(std::floor(step.x() + 0.5)), dy = int(std::floor(step.y() + 0.5));
  const int margin = int(std::ceil(near_));  // a joint along the border is no border between regions
  int64_t all = 0, again = 0, pixels = 0, near_ones = 0;
  double expected = 0;
  for (int y = 0; y < size_.height; y++)
    for (int x = 0; x < size_.width; x++) {
      int u = x + dx, v = y + dy;
      if (wraps_)
        u = wrap(u, size_.width), v = wrap(v, size_.height);
      else if (u < margin || v < margin || u >= size_.width - margin || v >= size_.height - margin)
        continue;
      const bool near = is_near(u, v);
      pixels++;
      near_ones += near;
      if (!joints_[size_t(y) * size_t(size_.width) + size_t(x)]) continue;
      all++;
      again += near;
      if (!near_of_line_.empty()) expected += near_of_line_[size_t(by_rows_ ? v : u)];
    }
  if (all == 0 || near_ones == pixels) return 0;  // nothing is told where all pixels are near a joint
  if (near_of_line_.empty()) expected = double(all) * double(near_ones) / double(pixels);
  return std::max(0.0, (double(again) - expected) / std::max(1.0, double(all) - expected));
}

double JointMap::in_step(const Lattice& lattice) const {
  return lattice.rank < 2 ? 0 : std::min(in_step(lattice.first), in_step(lattice.second));
}

std::vector<double> JointMap::near_shares(bool rows) const {
  std::vector<double> out(size_t(rows ? size_.height : size_.width), 0.0);
  const double length = rows ? size_.width : size_.height;
  for (int y = 0; y < size_.height; y++)
    for (int x = 0; x < size_.width; x++) out[size_t(rows ? y : x)] += is_near(x, y) / length;
  return out;
}

}  // namespace terrazzo
