#include "core/analysis/padded_level.h"

namespace terrazzo {

PaddedLevel::PaddedLevel(const AppearanceLevel& level, bool wraps)
    : size_(level.size), wraps_(wraps), stride_(level.size.width + 2 * margin) {
  vectors_.reserve(size_t(stride_) * (size_.height + 2 * margin));
  for (int y = -margin; y < size_.height + margin; y++)
    for (int x = -margin; x < size_.width + margin; x++) {
      const int u = wraps ? wrap(x, size_.width) : std::clamp(x, 0, size_.width - 1);
      const int v = wraps ? wrap(y, size_.height) : std::clamp(y, 0, size_.height - 1);
      vectors_.push_back(level.vectors[size_t(v) * size_.width + u]);
    }
}

}  // namespace terrazzo
