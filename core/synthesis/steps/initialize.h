#pragma once

#include <span>

#include "core/analysis/space/padded_level.h"
#include "core/exemplar/repeats.h"
#include "core/synthesis/state/control.h"
#include "core/synthesis/state/field.h"
#include "core/synthesis/state/plane_window.h"

/// What a level begins with, before it is corrected.
namespace terrazzo {

/// What a random number is drawn for: keeps the draws of different purposes apart.
enum Purpose : uint64_t {
  blocks = 1,
  jitter = 2,
  correction = 3,
  graphcut_repair = 4,
  piece_relocation = 5,
  coherence_repair = 6
};

/// The coarsest level: square blocks of a quarter of the exemplar's side, each the best of some from random places:
/// what a mask and `control`, which may be null, have least against, or what shows least near by.
Field random_blocks(const Plane& plane, const PaddedLevel& exemplar, const LevelControl* control,
                    const PartPhases& phase, uint64_t seed);

/// Moves every pixel of the coarsest level, number `level`, by up to `amplitude` pixels.
void scatter(Field& field, const PaddedLevel& exemplar, double amplitude, uint64_t seed, int level);

/// Where each pixel of a field leads on the next finer level: each becomes a block of four pixels, which continue one
/// another, and this is the exemplar pixel that the first of them shows. It is the one below the pixel's own, moved by
/// up to `amplitude` pixels and into phase. `exemplar`, `phase` and `level` are the finer ones.
Field block_starts(const Field& parent, const PlaneWindow& window, const PaddedLevel& exemplar, const PartPhases& phase,
                   double amplitude, uint64_t seed, int level);

/// The blocks' pixels. `starts` are those of the parents of what `to` holds, or more: `from` tells which.
Field expanded(std::span<const ExemplarPixel> starts, const PlaneWindow& from, const PlaneWindow& to,
               const PaddedLevel& exemplar);

}  // namespace terrazzo
