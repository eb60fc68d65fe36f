#pragma once

#include "core/synthesis/state/correction_level.h"

namespace terrazzo {

/// The pieces of a field: connected pixels that continue one another in the exemplar, not across its border. Numbered
/// in the order of their first pixels. Pixels may stand for blocks of several exemplar pixels a side. Pieces continue
/// across the borders of a field that wraps, or a seam would appear there.
class Pieces {
 public:
  explicit Pieces(const Field& field, int block = 1, bool wraps_x = false, bool wraps_y = false);

  int count() const { return int(begin_.size()) - 1; }
  int area(int piece) const { return begin_[piece + 1] - begin_[piece]; }
  int of(int pixel) const { return piece_[pixel]; }
  /// The piece's pixels, as y * width + x, ascending.
  std::span<const int> members(int piece) const { return {&members_[begin_[piece]], size_t(area(piece))}; }

 private:
  std::vector<int> piece_;    // of every pixel
  std::vector<int> begin_;    // of every piece in members_
  std::vector<int> members_;  // pixels, piece by piece
};

}  // namespace terrazzo
