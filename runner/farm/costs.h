#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

#include "core/base/hash.h"

/// What units of a kind have cost, as their processes measured it: cores and memory of the next ones are asked for by
/// that. A file for each kind in a folder that machines share; a record that is lost costs a good guess, nothing else.
namespace terrazzo {

struct UnitCost {
  double seconds = 0;      ///< of the last one
  double cpu_seconds = 0;  ///< likewise
  uint64_t memory = 0;     ///< bytes; the most that any has taken
};

/// None if no unit of this kind has been made yet.
std::optional<UnitCost> cost_of(const std::filesystem::path& costs, const Digest& kind);

/// Remembers what a unit has cost. Ignores errors.
void remember_cost(const std::filesystem::path& costs, const Digest& kind, UnitCost cost);

}  // namespace terrazzo
