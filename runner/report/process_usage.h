#pragma once

#include <cstdint>

namespace terrazzo {

/// The resources that the process has used since its start.
struct ProcessUsage {
  double cpu_seconds = 0;
  int64_t peak_memory = 0;  ///< bytes
};

ProcessUsage process_usage();

}  // namespace terrazzo
