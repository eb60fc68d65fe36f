#pragma once

#include <array>
#include <cstdint>

#include "core/synthesis/state/correction_level.h"

namespace terrazzo {

/// Finds windows of 7x7 pixels that are like no window of the exemplar, as where features are cut or seams show (the
/// coherence of Simakov et al., Summarizing visual data using bidirectional similarity, 2008). The scale is the
/// distance of the exemplar's own windows to their nearest ones. Immutable: any number of threads may ask.
class WindowCoherence {
 public:
  static constexpr int reach = 3;
  static constexpr int side = 2 * reach + 1;
  /// What a window shows, row by row.
  using Window = std::array<ExemplarPixel, side * side>;
  static constexpr int32_t most = 256;  ///< the unit of fixed-point incoherence

  explicit WindowCoherence(const CorrectionLevel& level);

  /// Whether a field of that length holds the window around a column or a row. `closed`: it wraps.
  static bool fits(int middle, int length, bool closed) {
    return closed || (middle >= reach && middle < length - reach);
  }

  /// From 0, for windows clearly nearer to the exemplar than most of its own are to one another, to `most`. The nearest
  /// window is sought among those that the window's pixels and their k-coherent candidates continue.
  int32_t incoherence(const Window& shown) const;

  /// How far the nearest window is: `most` for the usual distance, at most `farthest`; 0 for windows of the exemplar.
  static constexpr int32_t farthest = 4 * most;
  int32_t distance(const Window& shown) const;

 private:
  /// Whether the window is the exemplar's own.
  static bool is_copied(const Window& shown);
  const CorrectionLevel& level_;
  double usual_;  // squared distance within which most of the exemplar's windows have a similar one; 0: unknown
};

}  // namespace terrazzo
