#include <algorithm>

#include "core/synthesis/correction.h"

namespace terrazzo {

Occupancy::Occupancy(Size exemplar, double weight)
    : weight_(weight),
      cell_(std::max(2, std::max(exemplar.width, exemplar.height) / 16)),
      columns_((exemplar.width + cell_ - 1) / cell_),
      rows_((exemplar.height + cell_ - 1) / cell_),
      factors_(size_t(columns_) * rows_, unit_factor) {}

void Occupancy::recount(const Field& field) {
  if (!active()) return;
  std::vector<int64_t> use(factors_.size(), 0);
  for (const ExemplarPixel p : field.pixels) use[size_t(p.y / cell_) * columns_ + p.x / cell_]++;
  const double expected = double(field.size.area()) / double(factors_.size());
  for (size_t i = 0; i < use.size(); i++) {
    const double excess = std::clamp(double(use[i]) / expected - 1.0, 0.0, 4.0);
    factors_[i] = uint32_t(unit_factor * (1.0 + weight_ * excess));
  }
}

}  // namespace terrazzo
