#include "nodes/common/synthesis/synthesis_memory.h"

#include "core/exemplar/uv_map.h"
#include "nodes/common/synthesis/analysis_memory.h"

namespace terrazzo {

uint64_t coarse_memory(Size surface) {
  // Per block of 2x2 pixels: its source, its target, and its piece.
  return uint64_t(surface.area()) / 4 * (2 * sizeof(ExemplarPixel) + 4 * sizeof(int));
}

uint64_t synthesis_ahead(const InputForecasts& inputs, const SynthesisMemory& memory, std::optional<Size> result) {
  const uint64_t held = index_memory.of(inputs.at("index").front());
  return held > 0 && result ? held + memory.of(*result) : 0;
}

}  // namespace terrazzo
