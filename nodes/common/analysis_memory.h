#pragma once

#include <string>

#include "core/node/node.h"

namespace terrazzo {

/// What an analysis holds at its peak, in bytes for each pixel of the exemplar and for each value of a pixel in all
/// maps together. Measured with tests/bench/memory_budget.sh.
struct AnalysisMemory {
  uint64_t per_pixel = 0, per_value = 0;

  size_t of(const Material& exemplar) const;
  size_t of(const Features& features) const;
  /// Of a material, features, appearance space or index; 0 if its size is not known yet.
  uint64_t of(const Forecast& exemplar) const;
};
/// Of finding the lattice, which also tells whether an exemplar tiles.
inline constexpr AnalysisMemory lattice_memory{32, 6};
/// Of an index, with what making it and synthesis from it hold besides.
inline constexpr AnalysisMemory index_memory{48, 0};

/// How many values a pixel has in all maps that a material certainly has.
int values_of(const Forecast& material);

/// What a node says of the memory it takes that looks at the exemplar at `port`: a material or features.
void set_analysis_memory(NodeType& type, const std::string& port, const AnalysisMemory& memory);

}  // namespace terrazzo
