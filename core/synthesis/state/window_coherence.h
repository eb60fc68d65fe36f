#pragma once

#include <array>
#include <cstdint>

#include "core/synthesis/state/correction_level.h"

namespace terrazzo {

/// Tells windows of 7x7 pixels that are like some window of the exemplar from those that are like none, as where
/// features are cut or seams show (the coherence of Simakov et al., Summarizing visual data using bidirectional
/// similarity, 2008). How much a window may differ is what the exemplar's own windows do from those most like them.
/// Immutable: any number of threads may ask.
class WindowCoherence {
 public:
  static constexpr int reach = 3;
  static constexpr int side = 2 * reach + 1;
  /// What a window shows, row by row.
  using Window = std::array<ExemplarPixel, side * side>;
  static constexpr int32_t most = 256;

  explicit WindowCoherence(const CorrectionLevel& level);

  /// From 0, for what differs clearly less than the exemplar's own windows may, to `most`. Windows are sought where
  /// the window's pixels lead, and where their similar pixels do.
  int32_t incoherence(const Window& shown) const;

 private:
  const CorrectionLevel& level_;
  double usual_;  // squared distance that 95 of 100 of the exemplar's windows keep within; 0: it has none
};

}  // namespace terrazzo
