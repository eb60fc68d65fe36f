#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/base/task.h"
#include "core/synthesis/state/plane_window.h"
#include "core/synthesis/steps/element_holes.h"
#include "core/synthesis/steps/element_shapes.h"

namespace terrazzo {

/// Elements side by side: all of the result belongs to one of them.
class ElementPacking {
 public:
  /// `plane`: the result, in blocks of the shapes.
  ElementPacking(const ElementShapes& shapes, const Plane& plane);

  /// Of each block of the result whether something is kept there that belongs to none of the elements.
  void keep_off(const std::vector<uint8_t>& blocks);

  /// Takes away what others cover and fills the holes with the elements that fit them best and are seen least around
  /// there, until there is no hole left that one fits. Whole-element placement, as Hurtut et al., Appearance-guided
  /// synthesis of element arrangements by example (2009), with depth fields in place of their distances. Throws
  /// Cancelled.
  void pack(std::vector<PlacedElement> placed, const Task& task);

  /// A depth in 32nds of a block, up to 1024 blocks: surfaces have many of them.
  class Depth {
   public:
    Depth() = default;
    explicit Depth(float blocks) {
      const float units = std::clamp(blocks, -1023.0f, 1023.0f) * 32 + 0.5f;
      const int cut = int(units);  // std::floor is a call on baseline x86-64
      units_ = int16_t(float(cut) > units ? cut - 1 : cut);
    }
    float blocks() const { return float(units_) / 32; }

   private:
    int16_t units_ = 0;
  };
  struct Place {
    int placed = -1;  ///< which one the block belongs to: the one in which it lies deepest; -1: what keep_off() names
    Depth depth;      ///< in it
    Depth neighbour;  ///< in the next one, mostly negative; far below 0 if there is none near
  };
  const std::vector<PlacedElement>& placed() const { return placed_; }
  /// Also around the borders of a result that wraps; null outside of one that does not.
  const Place* find(int x, int y) const {
    const int64_t i = plane_.index(x, y);
    return i < 0 ? nullptr : &places_[size_t(i)];
  }

 private:
  template <typename Visit>
  void for_blocks(const PlacedElement& p, Visit visit) const;
  void paint(size_t placed);
  void paint_all();
  void measure_clear();
  void remove_overlapped(const Task& task);
  /// How well an element must fit.
  struct FitThresholds {
    double least_gain, overlap;
  };
  int fill_holes(const FitThresholds& terms, const Task& task);
  std::vector<Hole> holes() const;
  bool fill(const Hole& hole, const FitThresholds& terms);
  template <typename Visit>
  void for_places(const ElementShape& shape, const Hole& hole, Visit visit) const;
  int step() const;
  /// Whether a block is not part of a hole that no element fits.
  bool is_filled(const Place& p) const { return double(p.depth.blocks()) > -tolerance_; }
  double seen_around(int element, int column, int row) const;
  /// How well an element fits somewhere.
  struct Fit {
    double gain = 0;     ///< the share of it that fills holes, less what it covers of others
    double contact = 0;  ///< the share of its outline along which others end
    double value() const;
  };
  std::optional<Fit> fit(const ElementShape& shape, int column, int row, const FitThresholds& terms, double least,
                         int but = -1) const;
  float depth_but(const Place& p, int but) const {
    return (p.placed == but && but >= 0 ? p.neighbour : p.depth).blocks();
  }
  void settle(const Task& task);

  const ElementShapes& shapes_;
  Plane plane_;
  double tolerance_;  ///< by how many blocks an element may end too early without leaving a hole
  std::vector<PlacedElement> placed_;
  std::vector<Place> places_;
  std::vector<float> kept_depth_;                ///< of each block in what is kept; empty: nothing is
  std::vector<int> largest_first_;               ///< elements that may be laid
  std::vector<std::vector<size_t>> of_element_;  ///< of each element: where in placed_ it is
};

}  // namespace terrazzo
