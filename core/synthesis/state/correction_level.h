#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/analysis/space/padded_level.h"
#include "core/exemplar/repeats.h"
#include "core/synthesis/state/control.h"
#include "core/synthesis/state/fixed_pixels.h"
#include "core/synthesis/state/plane_window.h"

namespace terrazzo {

/// What all steps on one level read: the exemplar and its k-coherent candidates, the part of the plane that the field
/// holds, fixed pixels and controls; and what they may do. Borrows everything; thread-safe to read.
struct CorrectionLevel {
  const PaddedLevel& exemplar;
  /// k-coherent candidates: per_pixel positions for every exemplar pixel, row by row. Empty until passes begin.
  const std::vector<ExemplarPixel>& similar;
  int per_pixel = 0;
  int level = 0;       ///< 0 = finest; part of every random choice
  PlaneWindow window;  ///< the part of the plane that the field holds; if `block` is 2, of the next coarser plane
  PartPhases phase;    ///< of a regular exemplar: output pixels keep their phase in the lattice's cell
  FixedPixels fixed;   ///< pixels of the window's plane that no step changes
  const LevelControl* control = nullptr;  ///< null: there are no controls
  /// The element of each exemplar pixel, row by row, where pixels stay in the element that they show; else null.
  const uint16_t* elements = nullptr;
  /// A pixel of the field stands for `block` x `block` pixels of the level, which continue the exemplar pixel that it
  /// names: 2 while upsampling.
  int block = 1;

  /// The k-coherent candidates of an exemplar pixel.
  std::span<const ExemplarPixel> similar_to(const ExemplarPixel& p) const {
    return {similar.data() + (size_t(p.y) * size_t(exemplar.size().width) + p.x) * size_t(per_pixel),
            size_t(per_pixel)};
  }
  /// Whether a pixel of the field stays what it is.
  bool is_fixed(int column, int row) const { return fixed.any() && fixed.at(window.index(column, row)); }
  /// Whether a pixel of the field may show what begins at an exemplar position, which may lie outside: all of it is
  /// usable.
  bool holds(int u, int v) const {
    return exemplar.holds(u, v) && (block == 1 || exemplar.holds(u + block - 1, v + block - 1));
  }
  /// The same of an exemplar that tiles around its border: the position is moved into it.
  bool goes_on(int& u, int& v) const {
    if (!exemplar.wraps()) return holds(u, v);
    exemplar.settle_inside(u, v);
    return exemplar.is_usable(u, v);
  }
  /// Whether b lies so many blocks beside and below a in the exemplar, around its border if it tiles.
  bool is_next(const ExemplarPixel& a, const ExemplarPixel& b, int dx, int dy) const {
    int u = a.x + dx * block, v = a.y + dy * block;
    exemplar.unwind(u, v);
    return u == b.x && v == b.y;
  }
  /// Whether a pixel that shows `now` may come to show something usable instead: it is not fixed, does not get its past
  /// back, and suits the controls no less. `pixel`: of a field that holds the whole plane.
  bool may_change(int pixel, const ExemplarPixel& now, const ExemplarPixel& offered) const {
    const auto is_past = [&] {
      return fixed.is_past(size_t(pixel), {uint16_t(offered.x / block), uint16_t(offered.y / block)});
    };
    if (fixed.any() && (fixed.at(size_t(pixel)) || is_past())) return false;
    return !control || control_cost(pixel, offered) <= control_cost(pixel, now);
  }

 private:
  uint64_t control_cost(int pixel, const ExemplarPixel& shown) const;
};

}  // namespace terrazzo
