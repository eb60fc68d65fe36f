#pragma once

#include <cstdint>
#include <vector>

#include "core/synthesis/state/correction_level.h"
#include "core/synthesis/state/field.h"

namespace terrazzo {

/// Between which sizes continuing a piece costs no more than usual.
struct PieceLimits {
  double large;     ///< the upper size, as a share of the exemplar's area
  double fragment;  ///< the lower size, as a share of the upper

  /// `regular`: the exemplar has a lattice.
  static PieceLimits of(bool regular);
};

/// The coherence factor of the piece that each pixel is in, in `unit_factor`: what continuing the piece costs. It rises
/// with the size of pieces above the upper limit, so that none becomes a landmark that repeats. It rises towards
/// smaller sizes below the lower limit, so that fragments give way to their neighbours: fewer, equal pieces have fewer
/// seams.
std::vector<uint32_t> piece_coherence(const Field& field, const CorrectionLevel& level, double coherence,
                                      const PieceLimits& limits);

}  // namespace terrazzo
