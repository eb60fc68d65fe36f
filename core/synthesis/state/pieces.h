#pragma once

#include <vector>

#include "core/synthesis/state/field.h"

namespace terrazzo {

struct CorrectionLevel;

/// The pieces of a field: connected pixels that continue one another in the exemplar, around its border if it tiles.
/// Numbered in the order of their first pixels. Pixels may stand for blocks of several exemplar pixels a side. Pieces
/// continue across the borders of a field that wraps, or a seam would appear there.
class Pieces {
 public:
  Pieces(const Field& field, const CorrectionLevel& level);

  int count() const { return int(areas_.size()); }
  int area(int piece) const { return areas_[size_t(piece)]; }
  /// The piece's pixels, as y * width + x, ascending.
  std::vector<int> members(int piece) const;

 private:
  struct Run {
    int first, length;  // pixels side by side
  };
  std::vector<int> areas_;
  std::vector<int> begin_;  // of every piece in runs_
  std::vector<Run> runs_;   // piece by piece: far fewer than pixels
};

}  // namespace terrazzo
