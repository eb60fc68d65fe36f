#include "core/image/srgb.h"

namespace terrazzo {

const std::array<double, 256>& srgb_of_bytes() {
  static const std::array<double, 256> table = [] {
    std::array<double, 256> t{};
    for (size_t byte = 0; byte < t.size(); byte++) t[byte] = decode_srgb(double(float(byte) / 255));
    return t;
  }();
  return table;
}

}  // namespace terrazzo
