#pragma once

#include <string_view>

#include "core/image/image.h"

namespace terrazzo {

/// What makes an exemplar a bad one, as far as a look at its colours tells.
struct ExemplarFaults {
  double one_colour = 0;   ///< share of the pixels that are within 2/255 of the most frequent colour
  double brightening = 0;  ///< by how much the mean grows from one side to the opposite one, as a share of the darker
  double unevenness = 0;   ///< of the means of blocks around that trend, likewise
  std::string_view bright_side = "left", dark_side = "right";

  // The limits trade false alarms against faults that are missed: none of twelve photographed exemplars of all kinds
  // comes near them (tests have both sides).
  bool is_mostly_one_colour() const { return one_colour > 0.5; }
  /// A trend that stands out from what the texture does itself.
  bool is_lit_from_a_side() const { return brightening > 0.25 && brightening > 3 * unevenness; }
};

/// Looks at every pixel of an image once; only the first three channels count.
ExemplarFaults exemplar_faults(const Image& image);

}  // namespace terrazzo
