#include "runner/terminal/built_with.h"

#include <fmt/format.h>

#include "runner/api/plugin.h"

namespace terrazzo {

std::string built_with() {
  const char* sanitizers = TERRAZZO_SANITIZERS;
  return fmt::format("terrazzo {}\nbuilt with {}{}\nplug-in interface {}", TERRAZZO_VERSION, TERRAZZO_BUILT_WITH,
                     *sanitizers == 0 ? "" : fmt::format("\nsanitizers {}", sanitizers), plugin_abi);
}

}  // namespace terrazzo
