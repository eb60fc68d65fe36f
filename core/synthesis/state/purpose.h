#pragma once

#include <cstdint>

namespace terrazzo {

/// What a random number of a synthesis is drawn for: different purposes get independent numbers. Results depend on the
/// values.
enum class Purpose : uint64_t {
  blocks = 1,
  jitter = 2,
  correction = 3,
  graphcut_repair = 4,
  first_cell = 7,
  courses = 8
};

}  // namespace terrazzo
