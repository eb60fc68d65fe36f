#include "core/synthesis/state/usage_penalty.h"

#include <algorithm>

#include "core/base/tuning.h"

namespace terrazzo {

namespace {

struct UsagePenaltyTuning {
  double gain = 0.3;
  double most_step = 1;
  double least_price = 0.25;
  double most_price = 4;
};
const Tunable<UsagePenaltyTuning> usage_penalty_tuning(
    "usage_penalty",
    {
        {&UsagePenaltyTuning::gain, "gain", "price per excess",
         "the integral gain. Higher: rare features come back sooner, but use oscillates; lower: they stay rare",
         "usage_penalty"},
        {&UsagePenaltyTuning::most_step, "most_step", "uses too many",
         "higher: one count raises the price of over-used cells more, and use oscillates; lower: they stay over-used",
         "What each rule decides"},
        {&UsagePenaltyTuning::least_price, "least_price", "factor",
         "lower: cells that fit badly are forced in; higher: rare features are lost", "usage_penalty", 0, 1},
        {&UsagePenaltyTuning::most_price, "most_price", "factor",
         "higher: popular cells are avoided at any cost; lower: they stay over-used", "usage_penalty", 1, 1000},
    });

}  // namespace

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

void UsagePenalty::enable_integral_control() {
  if (active()) prices_.assign(factors_.size(), 1.0);
}

void UsagePenalty::enable_proximity_penalty(const Plane& plane) {
  if (active() && ProximityPenalty::is_worth_it(exemplar_, cells_, plane))
    nearby_.emplace(exemplar_, areas_, weight_, plane);
}

void UsagePenalty::recount(const Field& field, const FixedPixels& fixed) {
  if (frozen_) return;
  count(field.pixels, fixed);
  if (nearby_) nearby_->count(field, cells_);
}

void UsagePenalty::freeze_counts(std::span<const ExemplarPixel> pixels, const FixedPixels& fixed) {
  count(pixels, fixed);
  frozen_ = true;
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
  for (size_t i = 0; i < use.size(); i++) {
    const double expected = double(free) * (shares_.empty() ? 1 / double(use.size()) : shares_[i]);
    // Where less is wanted than the cell holds, a few whole pieces are better than bits of everything: to show all of
    // it once is not too much, and to leave it out hardly too little.
    const double used = double(use[i]), once = std::max({1.0, expected, areas_[i]});
    const double excess = used > once ? used / once - 1 : std::min(0.0, (used - expected) / once);
    // Under-used cells become cheaper as over-used ones become more expensive, but only down to a limit: an even use is
    // not worth broken features.
    double factor = std::max(least_factor_, 1.0 + weight_ * excess);
    if (!prices_.empty()) {
      const double raised =
          prices_[i] * (1 + usage_penalty_tuning->gain * std::min(usage_penalty_tuning->most_step, excess));
      prices_[i] = std::clamp(raised, usage_penalty_tuning->least_price, usage_penalty_tuning->most_price);
      factor = std::max(usage_penalty_tuning->least_price, factor * prices_[i]);
    }
    factors_[i] = uint32_t(unit_factor * factor);
  }
}

}  // namespace terrazzo
