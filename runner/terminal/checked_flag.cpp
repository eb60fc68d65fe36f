#include "runner/terminal/checked_flag.h"

#include <algorithm>
#include <cstdlib>
#include <string_view>

namespace terrazzo {

namespace {

#ifdef TERRAZZO_CHECKED
constexpr bool is_for_debugging = true;
#else
constexpr bool is_for_debugging = false;
#endif

bool is_usual() {
  return is_for_debugging && !std::getenv("TERRAZZO_CACHE");
}

}  // namespace

bool CheckedFlag::holds(const std::string& cache) const {
  return yes || (is_usual() && !no && cache.empty());
}

void add_checked_flag(Command& command, CheckedFlag& flag) {
  command.add_flag("--checked", &flag.yes,
                   "Run every node twice and watch what it reads. A node fails if it is not deterministic, or reads "
                   "files or environment variables that its key does not cover. Uses one thread and no cache");
  if (is_for_debugging)
    command.add_flag("--no-checked", &flag.no, "Do not check nodes; this debugging build does by default")
        .not_with("--checked");
}

bool may_be_checked(int argc, const char* const* argv) {
  return is_usual() || std::find(argv, argv + argc, std::string_view("--checked")) != argv + argc;
}

}  // namespace terrazzo
