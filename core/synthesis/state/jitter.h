#pragma once

#include <cstdint>
#include <vector>

#include "core/exemplar/appearance.h"

namespace terrazzo {

/// How random displacement is spread over the levels (after the per-level jitter of Lefebvre & Hoppe 2005,
/// section 3.2).
struct JitterSpec {
  enum class Shape : uint8_t {
    automatic,  ///< as list if there are amplitudes, else what suits the exemplar
    list,       ///< one amplitude per level, coarsest first, missing ones 0; a single one counts for every level
    constant,   ///< the first amplitude at every level
    peak,       ///< a Gaussian around the peak level
    rising,     ///< its coarser half: up to the peak level, none at finer ones
    falling,    ///< its finer half: from the peak level on, none at coarser ones
  };
  Shape shape = Shape::automatic;
  std::vector<double> amplitudes{};  ///< exemplar pixels of the level
  double peak = 0;                   ///< levels from the coarsest
  double spread = 1;                 ///< standard deviation in levels
};

/// The amplitude of each of the appearance's levels, coarsest first. The automatic choice is none, for every
/// exemplar: random starts, random candidates and evenness vary the result already, and on stochastic, irregular and
/// regular exemplars alike even a pixel of jitter at the coarsest levels cost coherence and completeness.
std::vector<double> jitter_amplitudes(const JitterSpec& spec, const Appearance& appearance);

}  // namespace terrazzo
