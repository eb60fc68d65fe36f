#pragma once

#include <cstdint>

namespace terrazzo {

/// Factors on costs are integers in 1/4096, so that every machine chooses alike.
inline constexpr uint32_t unit_factor = 4096;

}  // namespace terrazzo
