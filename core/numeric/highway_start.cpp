#include <hwy/nanobenchmark.h>

/// While loading, Highway's library measures its timer's resolution, which only its benchmarks need and which took 3 to
/// 4 of the 8 ms of `terrazzo --version`. A library loaded earlier, such as this one, can replace the function.
/// Measured: overhead.
namespace hwy::platform {

uint64_t TimerResolution() {
  return 1;
}

}  // namespace hwy::platform
