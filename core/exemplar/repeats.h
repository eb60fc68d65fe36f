#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "core/exemplar/lattice.h"
#include "core/exemplar/streaks.h"

/// How exemplars repeat that consist of several, side by side.
namespace terrazzo {

inline constexpr size_t most_lattice_parts = 255;

/// One of several exemplars that lie side by side in one.
struct LatticePart {
  Rect place;       ///< in pixels of the finest level; places do not overlap
  Lattice lattice;  ///< how it repeats
  /// How a result repeats where it shows this part: like the part itself or like another that is alike, so that cells,
  /// or courses, of both meet. Of the same rank, step by step: a cell of `lattice` is shown as a cell of this.
  Lattice shown;
  Vector2d start;  ///< the exemplar position that is in phase with the result's (0, 0)
  bool operator==(const LatticePart&) const = default;
};

/// How an exemplar repeats: as one, or each of its parts in its own way.
struct Repeats {
  Repeats() = default;
  Repeats(const Lattice& lattice) : lattice(lattice) {}
  /// The lattice of the largest part that repeats speaks for all of them.
  explicit Repeats(std::vector<LatticePart> several);

  Lattice lattice;                 ///< of all of the exemplar, or of most of it
  std::vector<LatticePart> parts;  ///< none: it repeats as one
  Streaks streaks;                 ///< what goes on along an axis; none of an exemplar of rank 2 or of several parts

  bool operator==(const Repeats&) const = default;
  void add_to(Hasher& h) const;
};

/// A LatticePhase for exemplars of one or several parts: every position goes by the lattice of the part it lies in, in
/// gaps by that of the nearest. Cheap to copy; thread-safe.
class PartPhases {
 public:
  PartPhases() = default;
  PartPhases(const Repeats& repeats, Size exemplar, int level, const LatticeSurface& surface);

  bool active() const { return active_; }
  /// Whether all lattices' cells are large enough to tell places within them apart.
  bool resolves_cells() const { return resolves_cells_; }
  /// Whether all that repeats does so by whole pixels (LatticePhase::is_whole).
  bool is_whole() const { return whole_; }
  // Inlined into what is compiled for newer processors, where rounding is one instruction.
  [[gnu::always_inline]] void snap(double x, double y, int& u, int& v) const { of(u, v).snap(x, y, u, v); }
  [[gnu::always_inline]] double penalty(int u, int v, double x, double y) const {
    const LatticePhase& phase = of(u, v);
    return phase.active() ? phase.penalty(u, v, x, y) : 1.0;
  }
  /// One of the result's positions that are in phase with the exemplar position (u, v); that itself where nothing
  /// repeats or all of the exemplar does as one.
  Vector2d shown_at(int u, int v) const {
    const LatticePhase& phase = of(u, v);
    return part_at_ && phase.active() ? phase.shown_at(u, v) : Vector2d{double(u), double(v)};
  }

 private:
  const LatticePhase& of(int u, int v) const {
    if (!part_at_) return one_;
    const size_t at = size_t(std::clamp(v, 0, size_.height - 1)) * size_.width + std::clamp(u, 0, size_.width - 1);
    return (*parts_)[(*part_at_)[at]];
  }

  bool active_ = false;
  bool resolves_cells_ = false;
  bool whole_ = false;
  LatticePhase one_;
  Size size_;  // of the level
  std::shared_ptr<const std::vector<LatticePhase>> parts_;
  std::shared_ptr<const std::vector<uint8_t>> part_at_;  // of every pixel of the level; null: there is only one
};

}  // namespace terrazzo
