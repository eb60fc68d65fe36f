#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/synthesis/state/cost_factor.h"
#include "core/synthesis/state/field.h"
#include "core/synthesis/state/fixed_pixels.h"
#include "core/synthesis/state/proximity_penalty.h"

namespace terrazzo {

/// A factor on the cost of using each cell of the exemplar (ExemplarCells) once more: above 1 for cells that show more
/// than an even share, and more than once as a whole; below 1 for cells that show less than their share. Any number of
/// threads may read while none counts.
class UsagePenalty {
 public:
  /// `weight`: what a doubled use adds to the cost; 0 turns the term off. `least_factor`: the smallest factor of cells
  /// that are used too little. `demand`: how often each exemplar pixel is wanted, relative to the others; empty:
  /// equally.
  UsagePenalty(Size exemplar, double weight, double least_factor, const std::vector<double>& demand = {});
  /// Fixed pixels do not count.
  void recount(const Field& field, const FixedPixels& fixed);
  /// Counts for the last time: recount() does nothing from now on.
  void freeze_counts(std::span<const ExemplarPixel> pixels, const FixedPixels& fixed);
  /// From now on factors accumulate: every count raises the price of cells that are used too much and lowers that of
  /// cells that are used too little (integral control). Else cells that fit badly everywhere would stay under-used.
  void enable_integral_control();
  /// From now on every count includes what shows near by (ProximityPenalty), until freeze_counts(). Counted fields
  /// must hold the whole plane. Fixed pixels count there.
  void enable_proximity_penalty(const Plane& plane);
  bool active() const { return weight_ > 0; }
  /// The factor at an exemplar pixel, in unit_factor.
  uint32_t factor(int x, int y) const { return factors_[cells_.of(x, y)]; }
  /// The factors of all cells at a position of the plane for what shows near by, in unit_factor; null if that does not
  /// count.
  const uint16_t* nearby_factors(int x, int y) const { return nearby_ ? nearby_->factors(x, y) : nullptr; }
  size_t cell(int x, int y) const { return cells_.of(x, y); }

 private:
  void count(std::span<const ExemplarPixel> pixels, const FixedPixels& fixed);

  double weight_;
  double least_factor_;
  bool frozen_ = false;
  Size exemplar_;
  ExemplarCells cells_;
  std::vector<double> areas_;   // usable pixels of each cell
  std::vector<double> shares_;  // the wanted share of each cell; empty: equal
  std::vector<double> prices_;  // accumulated factors; empty: only the last count matters
  std::vector<uint32_t> factors_;
  std::optional<ProximityPenalty> nearby_;
};

}  // namespace terrazzo
