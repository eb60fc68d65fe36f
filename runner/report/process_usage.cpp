#include "runner/report/process_usage.h"

#include <sys/resource.h>

namespace terrazzo {

ProcessUsage process_usage() {
  rusage used{};
  ::getrusage(RUSAGE_SELF, &used);
  const auto seconds = [](const timeval& t) { return double(t.tv_sec) + double(t.tv_usec) * 1e-6; };
  return {seconds(used.ru_utime) + seconds(used.ru_stime), int64_t{used.ru_maxrss} * 1024};
}

}  // namespace terrazzo
