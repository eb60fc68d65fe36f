#pragma once

#include <string_view>

#include "core/filter/lone_feature.h"
#include "core/image/image.h"

namespace terrazzo {

/// Faults of an exemplar that its colours reveal.
struct ExemplarFaults {
  double one_colour = 0;   ///< share of the pixels that are within 2/255 of the most frequent colour
  double brightening = 0;  ///< increase of the mean from one side to the opposite one, relative to the darker side
  double unevenness = 0;   ///< deviation of block means from that trend, likewise relative
  std::string_view bright_side = "left", dark_side = "right";
  LoneFeature lone{};

  // The limits trade false alarms against missed faults. None of twelve photographed exemplars of all kinds comes near
  // them (tests cover both sides).
  bool is_mostly_one_colour() const { return one_colour > 0.5; }
  /// A brightness trend that exceeds the texture's own variation.
  bool is_lit_from_a_side() const { return brightening > 0.25 && brightening > 3 * unevenness; }
};

/// Reads every pixel once; uses only the first three channels.
ExemplarFaults exemplar_faults(const Image& image);

}  // namespace terrazzo
