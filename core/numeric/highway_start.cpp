#include <hwy/nanobenchmark.h>

/// While it is loaded, Highway's library measures the resolution of its timer, which only its benchmarks need and which
/// takes 3 to 4 of the 8 ms that `terrazzo --version` took. Libraries that are loaded before it can replace the
/// function; this one is. Measured: overhead.
namespace hwy::platform {

uint64_t TimerResolution() {
  return 1;
}

}  // namespace hwy::platform
