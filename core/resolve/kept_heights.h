#pragma once

#include <cstdint>
#include <vector>

#include "core/image/image.h"

namespace terrazzo {

/// Heights that a result has already and that stay as they are.
struct KeptHeights {
  ImagePtr heights{};  ///< of one channel, at the result's scale; null: nothing is kept
  int x = 0, y = 0;    ///< where their top left pixel lies in the result; what lies beyond it does not count
  ImagePtr holes{};    ///< what is above 0.5 in its first channel is not kept; stretched over the result; null: none
};

/// The same, held in memory. Immutable, so thread-safe.
class KeptLookup {
 public:
  /// `result`: its size.
  KeptLookup(const KeptHeights& kept, Size result);

  bool any() const { return heights_ != nullptr; }
  /// The height that is kept at a pixel of the result; null if it is free.
  const float* at(int x, int y) const {
    if (!heights_ || x < area_.x || y < area_.y || x >= area_.right() || y >= area_.bottom()) return nullptr;
    const size_t i = size_t(y - area_.y) * size_t(area_.width) + size_t(x - area_.x);
    return !free_.empty() && free_[i] ? nullptr : heights_->in_memory() + i;
  }

 private:
  ImagePtr heights_;
  Rect area_;
  std::vector<uint8_t> free_;  ///< of the area; empty: nothing
};

}  // namespace terrazzo
