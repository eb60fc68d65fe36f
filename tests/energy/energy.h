#pragma once

#include <cstdint>

#include "core/base/task.h"
#include "core/synthesis/state/correction_level.h"
#include "core/synthesis/state/field.h"

namespace terrazzo {

/// What the field of a level costs, as sums of integers over a sample of its pixels: the terms of the energy that
/// texture synthesis by optimisation minimises (Kwatra et al., Texture optimization for example-based synthesis, 2005;
/// for the seams Kwatra et al., Graphcut textures, 2003).
struct Energy {
  int64_t pixels = 0;   ///< in the sample
  int64_t windows = 0;  ///< distances of 7x7 windows to their nearest in the exemplar, in WindowCoherence's unit
  int64_t unlike = 0;   ///< windows that are farther from all of the exemplar's than these from one another
  int64_t seams = 0;    ///< mismatch with the neighbours to the right and below, in parts of appearance units
  int64_t cut = 0;      ///< such neighbours that do not continue one another in the exemplar
  int64_t phase = 0;    ///< how much pixels are out of phase with the lattice, see PartPhases::penalty; 256ths above 1
};

/// At most about `sample` pixels are looked at, evenly spread. The same on every machine and for every number of
/// threads. Throws Cancelled.
Energy energy_of(Field field, const CorrectionLevel& level, int64_t sample, const Task& task);

}  // namespace terrazzo
