#pragma once

#include <string>

#include "core/node/node.h"

namespace terrazzo {

/// The peak memory of an analysis, in bytes per pixel of the exemplar plus bytes per value of all maps. Measured with
/// tests/bench/memory_budget.sh.
struct AnalysisMemory {
  uint64_t per_pixel = 0, per_value = 0;

  size_t of(const Material& exemplar) const;
  size_t of(const Features& features) const;
  /// For a material, features, appearance space or index; 0 if its size is unknown.
  uint64_t of(const Forecast& exemplar) const;
};
/// For finding the lattice, which also shows whether an exemplar tiles.
inline constexpr AnalysisMemory lattice_memory{32, 6};
/// For an index, including temporaries of building it and of synthesis from it.
inline constexpr AnalysisMemory index_memory{48, 0};

/// The number of values per pixel in all certain maps of a material.
int values_of(const Forecast& material);

/// Sets memory_hint and memory_ahead of a node type that analyses the exemplar at `port`: a material or features.
void set_analysis_memory(NodeType& type, const std::string& port, const AnalysisMemory& memory);

}  // namespace terrazzo
