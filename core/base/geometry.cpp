#include "core/base/geometry.h"

#include <cstdlib>

#include <fmt/format.h>

namespace terrazzo {

std::string describe(Size size) {
  return fmt::format("{}x{}", size.width, size.height);
}

bool same_shape(Size a, Size b) {
  const int64_t across = int64_t{a.width} * b.height, down = int64_t{a.height} * b.width;
  return std::abs(across - down) <= std::max({a.width, a.height, b.width, b.height});
}

}  // namespace terrazzo
