#pragma once

#include <cstdint>
#include <vector>

#include "core/analysis/space/padded_level.h"
#include "core/exemplar/repeats.h"
#include "core/synthesis/state/control.h"
#include "core/synthesis/state/fixed_pixels.h"
#include "core/synthesis/state/plane_window.h"

namespace terrazzo {

/// What all steps on one level read: the exemplar and its k-coherent candidates, the part of the plane that is held,
/// fixed pixels and controls. Borrows everything.
struct CorrectionLevel {
  const PaddedLevel& exemplar;
  const std::vector<ExemplarPixel>& similar;  ///< k-coherent candidates: per_pixel positions for every exemplar pixel
  int per_pixel = 0;
  int level = 0;       ///< 0 = finest; part of every random choice
  PlaneWindow window;  ///< the part of the plane that the field holds
  PartPhases phase;    ///< of a regular exemplar: output pixels keep their phase in the lattice's cell
  FixedPixels fixed;   ///< pixels of the plane that are not corrected
  const LevelControl* control = nullptr;  ///< null: there are no controls
  /// The element of each exemplar pixel, row by row, where pixels stay in the element that they show; else null.
  const uint16_t* elements = nullptr;
};

}  // namespace terrazzo
