#pragma once

#include <vector>

#include "core/synthesis/field.h"
#include "core/synthesis/plane_window.h"

namespace terrazzo {

/// Output pixels that are there already and stay as they are.
struct KeptPixels {
  std::vector<ExemplarPixel> pixels{};  ///< what each output pixel shows; of free ones it does not matter
  std::vector<uint8_t> keep{};          ///< 1: the pixel stays; 0: it is free. Both are empty if all are free
  bool empty() const { return keep.empty(); }
};

/// What of a level the kept pixels decide: the level's pixels below which all finest ones are kept.
class FixedPixels {
 public:
  /// Nothing is fixed.
  FixedPixels() = default;
  /// `output`: the finest level's size; `exemplar`: the exemplar's at `level`, 0 = the finest.
  FixedPixels(const KeptPixels& kept, Size output, int level, Size exemplar);

  bool any() const { return !fixed_.empty(); }
  bool at(size_t pixel) const { return !fixed_.empty() && fixed_[pixel]; }
  /// What a fixed pixel shows.
  ExemplarPixel shown(size_t pixel) const { return pixels_[pixel]; }
  /// Puts the fixed pixels into a field of the level.
  void apply(Field& field, const PlaneWindow& window) const;

 private:
  std::vector<uint8_t> fixed_;
  std::vector<ExemplarPixel> pixels_;
};

}  // namespace terrazzo
