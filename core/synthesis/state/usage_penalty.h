#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/synthesis/state/field.h"
#include "core/synthesis/state/fixed_pixels.h"
#include "core/synthesis/state/proximity_penalty.h"

namespace terrazzo {

/// Costs are multiplied by factors of 1/4096 (integers, so that every machine decides alike).
inline constexpr uint32_t unit_factor = 4096;

/// How often each cell of the exemplar (it is divided into 16x16) is in use, as a factor on the cost of using it once
/// more: above 1 where use exceeds an even share, and once all of the cell, below 1 where it falls short of it.
class UsagePenalty {
 public:
  /// `weight`: how much a doubled use adds to the cost; 0 turns the term off. `least_factor`: what the cost of
  /// a cell that is used too little falls to at most. `demand`: how often each exemplar pixel is wanted, relative to
  /// the others; empty: all alike.
  UsagePenalty(Size exemplar, double weight, double least_factor, const std::vector<double>& demand = {});
  /// Fixed pixels do not count.
  void recount(const Field& field, const FixedPixels& fixed);
  /// The same once and for all: recount() does nothing from now on.
  void count_for_good(std::span<const ExemplarPixel> pixels, const FixedPixels& fixed);
  /// From now on every count makes what is used too much dearer than the last, and what is used too little cheaper (the
  /// integral part of a controller): what fits badly everywhere would otherwise be used too little for ever.
  void insist();
  /// From now on every count also tells what shows near by (ProximityPenalty), until one is for good. The fields that
  /// are counted must hold the whole plane. Fixed pixels count there.
  void look_around(const Plane& plane);
  bool active() const { return weight_ > 0; }
  uint32_t factor(int x, int y) const { return factors_[cells_.of(x, y)]; }
  /// For showing each cell at a position of the plane, by what shows near by there alone; null unless it looks around.
  const uint16_t* nearby_factors(int x, int y) const { return nearby_ ? nearby_->factors(x, y) : nullptr; }
  size_t cell(int x, int y) const { return cells_.of(x, y); }

 private:
  void count(std::span<const ExemplarPixel> pixels, const FixedPixels& fixed);

  double weight_;
  double least_factor_;
  bool settled_ = false;
  Size exemplar_;
  ExemplarCells cells_;
  std::vector<double> areas_;   // of the cells: their usable pixels
  std::vector<double> shares_;  // of all use, by cell; empty: all alike
  std::vector<double> prices_;  // what all counts have made of each cell; empty: only the last matters
  std::vector<uint32_t> factors_;
  std::optional<ProximityPenalty> nearby_;
};

}  // namespace terrazzo
