#pragma once

#include <cstdint>

namespace terrazzo {

/// What the process has used since it began.
struct ProcessUsage {
  double cpu_seconds = 0;
  int64_t peak_memory = 0;  ///< bytes
};

ProcessUsage process_usage();

}  // namespace terrazzo
