#include "core/lattice.h"

namespace terrazzo {

LatticePhase::Matrix LatticePhase::inverse(const Matrix& m) {
  const double d = 1.0 / (m.xx * m.yy - m.xy * m.yx);
  return {m.yy * d, -m.xy * d, -m.yx * d, m.xx * d};
}

LatticePhase::LatticePhase(const Lattice& lattice, int level, Size output, bool tile_x, bool tile_y)
    : rank_(lattice.rank) {
  if (rank_ == 0) return;
  const double scale = 1.0 / double(int64_t{1} << level);
  first_ = {lattice.first.x * scale, lattice.first.y * scale};
  second_ = {lattice.second.x * scale, lattice.second.y * scale};
  const double cell =
      rank_ == 1 ? std::abs(first_.x + first_.y) : std::sqrt(std::abs(first_.x * second_.y - first_.y * second_.x));
  if (cell < smallest_cell) {
    rank_ = 0;
    return;
  }
  const auto cells_along = [](double cells, bool tiles) { return tiles ? nearest(cells) : cells; };
  if (rank_ == 1) {
    const bool columns = first_.x != 0;
    const double length = columns ? output.width : output.height;
    const double cells = cells_along(length / cell, columns ? tile_x : tile_y);
    const double output_period = cells > 0 ? length / cells : cell;
    (columns ? to_exemplar_.xx : to_exemplar_.xy) = 1 / cell;
    (columns ? to_output_.xx : to_output_.xy) = 1 / output_period;
    return;
  }
  to_exemplar_ = inverse({first_.x, second_.x, first_.y, second_.y});
  // The cells that the output spans along each axis, whole where it wraps around.
  const Matrix& e = to_exemplar_;
  const double w = output.width, h = output.height;
  const Matrix spans{cells_along(e.xx * w, tile_x), cells_along(e.xy * h, tile_y), cells_along(e.yx * w, tile_x),
                     cells_along(e.yy * h, tile_y)};
  const bool too_small = std::abs(spans.xx * spans.yy - spans.xy * spans.yx) < 0.5;
  to_output_ = too_small ? to_exemplar_ : Matrix{spans.xx / w, spans.xy / h, spans.yx / w, spans.yy / h};
}

}  // namespace terrazzo
