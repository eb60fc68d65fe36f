#pragma once

#include <array>
#include <cstdint>

#include "core/synthesis/state/correction_level.h"

namespace terrazzo {

/// How far windows of 7x7 pixels are from all of the exemplar's, as where features are cut or seams show (the
/// coherence of Simakov et al., Summarizing visual data using bidirectional similarity, 2008). The scale is the
/// distance of the exemplar's own windows to their nearest ones. Immutable: any number of threads may ask.
class WindowCoherence {
 public:
  static constexpr int reach = 3;
  static constexpr int side = 2 * reach + 1;
  /// What a window shows, row by row.
  using Window = std::array<ExemplarPixel, side * side>;
  static constexpr int32_t usual = 256;  ///< the distance that 95 of 100 of the exemplar's windows keep to

  explicit WindowCoherence(const CorrectionLevel& level);

  /// Whether a field of that length holds the window around a column or a row. `closed`: it wraps.
  static bool fits(int middle, int length, bool closed) {
    return closed || (middle >= reach && middle < length - reach);
  }

  /// How far the nearest window is, at most `farthest`; 0 for windows of the exemplar. It is sought among those that
  /// the window's pixels and their k-coherent candidates continue.
  static constexpr int32_t farthest = 4 * usual;
  int32_t distance(const Window& shown) const;

 private:
  /// Whether the window is the exemplar's own.
  static bool is_copied(const Window& shown);
  const CorrectionLevel& level_;
  double usual_;  // squared distance within which most of the exemplar's windows have a similar one; 0: unknown
};

}  // namespace terrazzo
