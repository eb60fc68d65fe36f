#pragma once

#include <cstdint>
#include <vector>

#include "core/synthesis/state/correction_level.h"
#include "core/synthesis/state/usage_penalty.h"

namespace terrazzo {

/// What is too large and too small for a piece.
struct PieceLimits {
  double large;     ///< of the exemplar
  double fragment;  ///< of a large piece

  static PieceLimits of(bool regular);
};

/// The factor on continuing the piece that each pixel is in, in `unit_factor`. The larger a piece has become beyond a
/// fair size, the less it pays to continue it, so that none comes back as a landmark. Fragments are dear as well: they
/// give way to their neighbours, for there are fewer seams between a few pieces of a size than among many.
std::vector<uint32_t> piece_coherence(const Field& field, const CorrectionLevel& level, double coherence,
                                      const PieceLimits& limits);

}  // namespace terrazzo
