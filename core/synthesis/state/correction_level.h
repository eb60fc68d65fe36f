#pragma once

#include <vector>

#include "core/analysis/space/padded_level.h"
#include "core/exemplar/repeats.h"
#include "core/synthesis/state/control.h"
#include "core/synthesis/state/fixed_pixels.h"
#include "core/synthesis/state/plane_window.h"

namespace terrazzo {

/// What all steps on one level look at: the exemplar and its candidates, the part of the plane, what is fixed and what
/// steers. Borrows everything.
struct CorrectionLevel {
  const PaddedLevel& exemplar;
  const std::vector<ExemplarPixel>& similar;  ///< per_pixel positions for every exemplar pixel
  int per_pixel = 0;
  int level = 0;       ///< 0 = finest; part of every random choice
  PlaneWindow window;  ///< what the field holds of the plane
  PartPhases phase;    ///< of a regular exemplar: every output pixel keeps its place in the lattice's cell
  FixedPixels fixed;   ///< pixels of the plane that are not corrected
  const LevelControl* control = nullptr;  ///< null: nothing steers
};

}  // namespace terrazzo
