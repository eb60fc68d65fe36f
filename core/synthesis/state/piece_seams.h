#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/synthesis/state/correction_level.h"
#include "core/synthesis/state/pieces.h"

namespace terrazzo {

/// One exemplar pixel on each side of where a piece meets another.
struct PieceSeam {
  ExemplarPixel inside;  ///< what the piece shows
  ExemplarPixel beyond;  ///< what the other shows
  int dx, dy;            ///< from inside to beyond
};
using PieceSeams = std::vector<PieceSeam>;

/// The pieces of a field, where they meet, and how well they would fit there if they showed another part of the
/// exemplar. A pixel of the field stands for a block of `block` x `block` pixels of the level, which continue the
/// exemplar pixel it names. Pieces stay those of the field as it was at first. Any number of threads may ask, as long
/// as none changes what they ask about.
class PieceGround {
 public:
  PieceGround(const Field& field, int block, const CorrectionLevel& level)
      : field_(field),
        block_(block),
        level_(level),
        pieces_(field, block, level.window.closed_x, level.window.closed_y) {}

  const Pieces& pieces() const { return pieces_; }

  /// The pixel beyond a side; -1 if there is none.
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

  /// Adds the seams along one side of a pixel, which is a border.
  void add_seams(int pixel, int side, PieceSeams& seams) const {
    const auto [dx, dy] = sides[side];
    const ExemplarPixel p = field_.pixels[size_t(pixel)], q = field_.pixels[size_t(beyond(pixel, side))];
    for (int k = 0; k < block_; k++) seams.push_back({on_side(p, dx, dy, k), on_side(q, -dx, -dy, k), dx, dy});
  }

  bool is_fixed(int piece) const;
  /// Whether the exemplar has usable pixels for the whole piece where a move would take it.
  bool has_room(int piece, int dx, int dy) const;
  /// What moved pieces and those beyond their seams show too differently there; gives up beyond the limit.
  int64_t mismatch(const PieceSeams& seams, int dx, int dy, int64_t limit) const;
  /// The factor on that for a piece which is out of phase with the lattice once moved.
  double penalty(int piece, int dx, int dy) const;

 private:
  /// The k-th pixel along one of the sides of the block that begins with p.
  ExemplarPixel on_side(ExemplarPixel p, int dx, int dy, int k) const;

  const Field& field_;
  int block_;
  const CorrectionLevel& level_;
  Pieces pieces_;
};

}  // namespace terrazzo
