#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/synthesis/state/correction_level.h"
#include "core/synthesis/state/pieces.h"

namespace terrazzo {

/// A pixel's length of seam: the exemplar pixels that a piece and its neighbour show on the two sides.
struct PieceSeam {
  ExemplarPixel inside;  ///< what the piece shows
  ExemplarPixel beyond;  ///< what its neighbour shows
  int dx, dy;            ///< from inside to beyond
};
using PieceSeams = std::vector<PieceSeam>;

/// The pieces of a field, their seams, and how well they would fit along them if they showed another part of the
/// exemplar. A pixel of the field stands for a block of `block` x `block` pixels of the level, which continue the
/// exemplar pixel it names. Which pixels belong to a piece is decided once, by the field at construction. Any number of
/// threads may read as long as none changes the pixels that they read.
class PieceGround {
 public:
  PieceGround(const Field& field, int block, const CorrectionLevel& level)
      : field_(field),
        block_(block),
        level_(level),
        pieces_(field, block, level.window.closed_x, level.window.closed_y) {}

  const Pieces& pieces() const { return pieces_; }

  /// The pixel's neighbour on a side; -1 if there is none.
  int64_t beyond(int pixel, int side) const {
    return pixel_beside(field_.size, pixel, side, level_.window.closed_x, level_.window.closed_y);
  }

  /// Calls `visit(pixel, side)` for each side of a piece's pixels that is a border with another piece.
  template <typename Visit>
  void for_each_border(int piece, const Visit& visit) const {
    for (const int i : pieces_.members(piece))
      for (int side = 0; side < 4; side++) {
        const int64_t n = beyond(i, side);
        if (n >= 0 && pieces_.of(int(n)) != piece) visit(uint32_t(i), uint32_t(side));
      }
  }

  /// Adds the seams along one side of a pixel, which must be a border.
  void add_seams(int pixel, int side, PieceSeams& seams) const {
    const auto [dx, dy] = sides[side];
    const ExemplarPixel p = field_.pixels[size_t(pixel)], q = field_.pixels[size_t(beyond(pixel, side))];
    for (int k = 0; k < block_; k++) seams.push_back({on_side(p, dx, dy, k), on_side(q, -dx, -dy, k), dx, dy});
  }

  bool is_fixed(int piece) const;
  /// Whether the whole piece would show usable pixels of the exemplar if it were moved there.
  bool has_room(int piece, int dx, int dy) const;
  /// The squared distances along a moved piece's seams: between what it shows and what continues its neighbour, and the
  /// other way around. Stops beyond the limit.
  int64_t mismatch(const PieceSeams& seams, int dx, int dy, int64_t limit) const;
  /// The factor on that for being out of phase with the lattice once moved.
  double penalty(int piece, int dx, int dy) const;

 private:
  /// The k-th pixel along the side towards (dx, dy) of the block that begins with p.
  ExemplarPixel on_side(ExemplarPixel p, int dx, int dy, int k) const;

  const Field& field_;
  int block_;
  const CorrectionLevel& level_;
  Pieces pieces_;
};

}  // namespace terrazzo
