#pragma once

#include <cstdint>
#include <vector>

#include "core/analysis/space/padded_level.h"
#include "core/exemplar/repeats.h"
#include "core/synthesis/state/control.h"
#include "core/synthesis/state/fixed_pixels.h"
#include "core/synthesis/state/plane_window.h"

namespace terrazzo {

/// What all steps on one level read: the exemplar and its k-coherent candidates, the part of the plane that the field
/// holds, fixed pixels and controls. Borrows everything; thread-safe to read.
struct CorrectionLevel {
  const PaddedLevel& exemplar;
  /// k-coherent candidates: per_pixel positions for every exemplar pixel, row by row. Empty unless a step that applies
  /// has Step::reads_candidates.
  const std::vector<ExemplarPixel>& similar;
  int per_pixel = 0;
  int level = 0;       ///< 0 = finest; part of every random choice
  PlaneWindow window;  ///< the part of the plane that the field holds; if `block` is 2, of the next coarser plane
  PartPhases phase;    ///< of a regular exemplar: output pixels keep their phase in the lattice's cell
  FixedPixels fixed;   ///< pixels of the window's plane that no step changes
  const LevelControl* control = nullptr;  ///< null: there are no controls
  /// The element of each exemplar pixel, row by row, where pixels stay in the element that they show; else null.
  const uint16_t* elements = nullptr;
  /// A pixel of the field stands for `block` x `block` pixels of the level, which continue the exemplar pixel that it
  /// names: 2 while upsampling.
  int block = 1;
};

}  // namespace terrazzo
