#pragma once

#include <cstdint>
#include <span>

#include "core/analysis/space/padded_level.h"
#include "core/exemplar/repeats.h"
#include "core/synthesis/state/control.h"
#include "core/synthesis/state/field.h"
#include "core/synthesis/state/plane_window.h"

/// The initial field of a level, before correction.
namespace terrazzo {

/// The coarsest level: square blocks of a quarter of the exemplar's side, each the best of several random ones: the one
/// of least cost under a mask and `control`, which may be null, or without these the one that repeats least near by.
Field random_blocks(const Plane& plane, const PaddedLevel& exemplar, const LevelControl* control,
                    const PartPhases& phase, uint64_t seed);

/// Moves every pixel of the coarsest level, number `level`, by up to `amplitude` pixels.
void scatter(Field& field, const PaddedLevel& exemplar, double amplitude, uint64_t seed, int level);

/// Upsampling to the next finer level: each pixel becomes a block of four, which continue one another, and this is the
/// exemplar pixel that the first of them shows: the pixel's own position doubled, displaced by up to `amplitude` pixels
/// and snapped into phase. `exemplar`, `phase` and `level` are the finer ones.
Field block_starts(const Field& parent, const PlaneWindow& window, const PaddedLevel& exemplar, const PartPhases& phase,
                   double amplitude, uint64_t seed, int level);

/// The pixels of the blocks. `starts` covers the part `from`, which includes all blocks of the part `to`.
Field expanded(std::span<const ExemplarPixel> starts, const PlaneWindow& from, const PlaneWindow& to,
               const PaddedLevel& exemplar);

}  // namespace terrazzo
