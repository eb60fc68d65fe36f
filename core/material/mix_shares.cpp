#include "core/material/mix_shares.h"

#include <algorithm>
#include <cmath>

namespace terrazzo {

namespace {

constexpr double least_softness = 1e-6;  ///< so that equal heights keep a share

}  // namespace

void MixShares::set(const float* distance, const float* height) {
  const size_t own = size_t(std::max_element(distance, distance + shares_.size()) - distance);
  std::fill(sunk_.begin(), sunk_.end(), 0.0f);
  if (double(distance[own]) >= shape_.half()) {
    std::fill(shares_.begin(), shares_.end(), 0.0f);
    shares_[own] = 1;
    return;
  }
  if (shape_.border == Border::height)
    compare(distance, height);
  else
    fade(distance);
  normalise();
}

void MixShares::fade(const float* distance) {
  for (size_t i = 0; i < shares_.size(); i++) {
    const double t = std::clamp(0.5 + double(distance[i]) / shape_.width, 0.0, 1.0);
    shares_[i] = float(t * t * (3 - 2 * t));
  }
}

void MixShares::compare(const float* distance, const float* height) {
  const double softness = std::max(shape_.softness, least_softness);
  // Lowered by this, an intruder's highest point lies below all others' lowest points by more than the softness.
  const double deepest = 1 + softness + std::fabs(shape_.offset) * double(shares_.size() - 1);
  double top = -deepest;
  for (size_t i = 0; i < shares_.size(); i++) {
    const double above = shape_.range > 0 ? (double(height[i]) - shape_.lowest) / shape_.range : 0;
    const double out = std::clamp(-double(distance[i]) / shape_.half(), 0.0, 1.0), sinks = out * out * out * deepest;
    const double counts = (std::isfinite(above) ? std::clamp(above, 0.0, 1.0) : 0) + shape_.offset * double(i) - sinks;
    shares_[i] = float(counts);
    sunk_[i] = float(sinks * shape_.range);
    top = std::max(top, double(shares_[i]));
  }
  for (float& share : shares_) share = float(std::max(0.0, double(share) - top + softness));
}

void MixShares::normalise() {
  float sum = 0;
  for (const float share : shares_) sum += share;
  for (float& share : shares_) share /= sum;
}

}  // namespace terrazzo
