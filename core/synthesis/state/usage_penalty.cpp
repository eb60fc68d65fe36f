#include "core/synthesis/state/usage_penalty.h"

#include <algorithm>

namespace terrazzo {

// Pixels of a cell that hardly ever should be used: keeps the excess finite.
constexpr double least_expected = 1e-6;
// How much a count adds to a cell's price, for a use that is doubled; and what prices may become.
constexpr double insistence = 0.3;
constexpr double least_price = 0.25, most_price = 4;

UsagePenalty::UsagePenalty(Size exemplar, double weight, double least_factor, const std::vector<double>& demand)
    : weight_(weight),
      least_factor_(least_factor),
      exemplar_(exemplar),
      cells_(exemplar),
      factors_(cells_.count, unit_factor) {
  if (!active()) return;
  areas_.assign(factors_.size(), 0.0);
  for (int y = 0; y < exemplar.height; y++)
    for (int x = 0; x < exemplar.width; x++)
      areas_[cells_.of(x, y)] += demand.empty() || demand[size_t(y) * exemplar.width + x] > 0;
  if (demand.empty()) return;
  shares_.assign(factors_.size(), 0.0);
  double sum = 0;
  for (const double d : demand) sum += d;
  for (size_t i = 0; i < demand.size(); i++)
    shares_[cells_.of(int(i) % exemplar.width, int(i) / exemplar.width)] += demand[i] / sum;
}

void UsagePenalty::insist() {
  if (active()) prices_.assign(factors_.size(), 1.0);
}

void UsagePenalty::look_around(const Plane& plane) {
  if (active() && ProximityPenalty::is_worth_it(exemplar_, cells_, plane))
    nearby_.emplace(exemplar_, areas_, weight_, plane);
}

void UsagePenalty::recount(const Field& field, const FixedPixels& fixed) {
  if (settled_) return;
  count(field.pixels, fixed);
  if (nearby_) nearby_->count(field, cells_);
}

void UsagePenalty::count_for_good(std::span<const ExemplarPixel> pixels, const FixedPixels& fixed) {
  count(pixels, fixed);
  settled_ = true;
  nearby_.reset();
}

void UsagePenalty::count(std::span<const ExemplarPixel> pixels, const FixedPixels& fixed) {
  if (!active()) return;
  std::vector<int64_t> use(factors_.size(), 0);
  int64_t free = 0;
  for (size_t i = 0; i < pixels.size(); i++) {
    if (fixed.at(i)) continue;
    use[cells_.of(pixels[i])]++;
    free++;
  }
  const double even = std::max(least_expected, double(free) / double(factors_.size()));
  for (size_t i = 0; i < use.size(); i++) {
    const double expected = shares_.empty() ? even : std::max(least_expected, double(free) * shares_[i]);
    // Where less is wanted than there is, a few pieces of it are better than bits of everything: to show one once is
    // not too much, and to leave others out hardly too little.
    const double used = double(use[i]), once = std::max(expected, areas_[i]);
    const double excess = used > once ? std::min(4.0, used / once - 1) : std::min(0.0, (used - expected) / once);
    // What is used too little is made cheaper as what is used too much is made dearer, but only so far: to be
    // everywhere alike is not worth breaking features for.
    double factor = std::max(least_factor_, 1.0 + weight_ * excess);
    if (!prices_.empty()) {
      prices_[i] = std::clamp(prices_[i] * (1 + insistence * std::min(1.0, excess)), least_price, most_price);
      factor = std::max(least_price, factor * prices_[i]);
    }
    factors_[i] = uint32_t(unit_factor * factor);
  }
}

}  // namespace terrazzo
