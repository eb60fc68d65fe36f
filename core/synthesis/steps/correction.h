#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/analysis/space/padded_level.h"
#include "core/base/task.h"
#include "core/exemplar/repeats.h"
#include "core/synthesis/state/comparison_window.h"
#include "core/synthesis/state/control.h"
#include "core/synthesis/state/field.h"
#include "core/synthesis/state/fixed_pixels.h"
#include "core/synthesis/state/plane_window.h"
#include "core/synthesis/state/usage_penalty.h"

namespace terrazzo {

/// What the correction of one level works with.
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

struct CorrectionPass {
  const Window* window = nullptr;
  uint32_t coherence = unit_factor;  ///< factor on candidates that continue a neighbour
  /// If not empty, per output pixel instead: the factor on continuing the piece it is in.
  std::vector<uint32_t> piece_coherence{};
  int random_candidates = 0;
  uint64_t seed = 0;
  int pass = 0;
  Rect wanted;  ///< the columns and rows that have to be right after the pass; it spoils others
};

/// How far beyond a pixel its correction looks, in each of a pass's sub-passes.
inline constexpr int correction_reach = 6;
inline constexpr int sub_passes = 4;

/// One correction pass (Lefebvre & Hoppe 2005, section 4.3): every pixel takes the best of its neighbours'
/// continuations, their similar pixels and some random places. It runs as four sub-passes over interleaved pixels, each
/// of which reads what the one before has left: the result does not depend on the order of work, nor on which part of
/// the plane the field holds. Throws Cancelled.
void correct(Field& field, const CorrectionLevel& level, const CorrectionPass& pass, UsagePenalty& usage,
             const Task& task);

}  // namespace terrazzo
