#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

#include "core/base/hash.h"

/// Measured costs of earlier units by kind, from which the cores and memory of further units are estimated. One file
/// per kind in a shared folder. A lost record only makes the estimate worse.
namespace terrazzo {

struct UnitCost {
  double seconds = 0;      ///< of the last unit
  double cpu_seconds = 0;  ///< likewise
  uint64_t memory = 0;     ///< in bytes; the maximum over all units
};

/// Nullopt if no unit of this kind has run yet.
std::optional<UnitCost> cost_of(const std::filesystem::path& costs, const Digest& kind);

/// Records a unit's cost. Ignores errors.
void remember_cost(const std::filesystem::path& costs, const Digest& kind, UnitCost cost);

}  // namespace terrazzo
