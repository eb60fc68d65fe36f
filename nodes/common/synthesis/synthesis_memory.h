#pragma once

#include "core/node/node.h"

/// The memory that synthesis takes, in bytes. Measured with tests/bench/memory_budget.sh.
namespace terrazzo {

/// Peak memory per pixel of the result.
struct SynthesisMemory {
  uint64_t per_pixel = 0;
  uint64_t of(Size result) const { return uint64_t(result.area()) * per_pixel + (uint64_t{16} << 20); }
};
/// The pixels, a sub-pass's corrections, and the initial blocks.
inline constexpr SynthesisMemory new_pixels_memory{6};
/// With kept pixels: additionally their mask and content on every level.
inline constexpr SynthesisMemory exemplar_kept_memory{22};
inline constexpr SynthesisMemory result_kept_memory{26};
/// The same for filling holes in an earlier result, which needs their distances first.
inline constexpr SynthesisMemory result_filled_memory{35};

/// What controls add per pixel of the result: for each of their values, and for distances to labels.
inline constexpr uint64_t control_value_memory = 2, label_distances_memory = 21;

/// The memory of a surface's coarse levels.
uint64_t coarse_memory(Size surface);

/// For NodeType::memory_ahead: the memory of the index, of temporaries, and `memory` of a result of this size. 0 if any
/// of them is unknown.
uint64_t synthesis_ahead(const InputForecasts& inputs, const SynthesisMemory& memory, std::optional<Size> result);

}  // namespace terrazzo
