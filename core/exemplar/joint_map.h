#pragma once

#include <cstdint>
#include <vector>

#include "core/exemplar/elements.h"
#include "core/exemplar/lattice.h"

namespace terrazzo {

/// Where an exemplar has joints between elements, and how near any pixel is to one. `bands`: courses or columns that
/// are known, if any. Immutable; thread-safe.
class JointMap {
 public:
  JointMap(const Elements& elements, bool wraps, const Lattice& bands = {});

  /// How surely joints come again a step further: 0, no more than by chance; 1, all of them. Chance is that of any
  /// pixel or, of bands, of any in the same row or column: joints along them say nothing of cells.
  double in_step(const Vector2d& step) const;
  /// The lesser of both steps; 0 of a rank below 2.
  double in_step(const Lattice& lattice) const;

  /// So far from a joint, in pixels, a pixel is near it.
  double near() const { return near_; }
  bool is_near(int x, int y) const {
    return double(squared_[size_t(y) * size_t(size_.width) + size_t(x)]) <= near_ * near_;
  }
  /// Of each row, or column: the share of its pixels that are near a joint.
  std::vector<double> near_shares(bool rows) const;

 private:
  Size size_;
  bool wraps_;
  double near_;
  std::vector<uint8_t> joints_;
  std::vector<int64_t> squared_;
  bool by_rows_;                      // bands are courses
  std::vector<double> near_of_line_;  // empty without bands
};

}  // namespace terrazzo
