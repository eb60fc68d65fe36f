#pragma once

#include <cstdint>
#include <span>

#include "core/synthesis/state/correction_level.h"
#include "core/synthesis/state/field.h"

/// The initial field of a level, before correction.
namespace terrazzo {

/// The coarsest level: square blocks of a quarter of the exemplar's side, each the best of several random ones: the one
/// of least cost under a mask and controls, or without these the one that repeats least near by.
Field random_blocks(const CorrectionLevel& level, uint64_t seed);

/// Moves every pixel of the coarsest level by up to `amplitude` pixels.
void scatter(Field& field, const CorrectionLevel& level, double amplitude, uint64_t seed);

/// Upsampling to the next finer level: each pixel becomes a block of four, which continue one another, and this is the
/// exemplar pixel that the first of them shows: the pixel's own position doubled, displaced by up to `amplitude` pixels
/// and snapped into phase. `level`: the finer one, see CorrectionLevel::block.
Field block_starts(const Field& parent, const CorrectionLevel& level, double amplitude, uint64_t seed);

/// The pixels of the blocks. `starts` covers the part `from`, which includes all blocks of the part `to`.
Field expanded(std::span<const ExemplarPixel> starts, const PlaneWindow& from, const PlaneWindow& to,
               const PaddedLevel& exemplar);

}  // namespace terrazzo
