#pragma once

#include "core/node/node.h"

/// Bytes that synthesis takes. Measured: memory_budget.
namespace terrazzo {

/// What it holds for each pixel of the result at its peak.
struct SynthesisMemory {
  uint64_t per_pixel = 0;
  uint64_t of(Size result) const { return uint64_t(result.area()) * per_pixel + (uint64_t{16} << 20); }
};
/// The pixels, those that a sub-pass has corrected, and the blocks they began with.
inline constexpr SynthesisMemory new_pixels_memory{6};
/// Around pixels that are kept: besides, which they are and what they show, on every level.
inline constexpr SynthesisMemory exemplar_kept_memory{22};
inline constexpr SynthesisMemory result_kept_memory{26};
/// The same with holes in an earlier result, of which distances are taken first.
inline constexpr SynthesisMemory result_filled_memory{35};

/// What controls add for each pixel of the result: for each of their values, and for distances to labels.
inline constexpr uint64_t control_value_memory = 2, label_distances_memory = 21;

/// Of the coarse levels of a surface.
uint64_t coarse_memory(Size surface);

/// For NodeType::memory_ahead: what an index takes with all that synthesis from it holds besides, and `memory` of a
/// result of that size. 0 if not all of it is known.
uint64_t synthesis_ahead(const InputForecasts& inputs, const SynthesisMemory& memory, std::optional<Size> result);

}  // namespace terrazzo
