#pragma once

#include <cstdint>
#include <vector>

#include "core/image/image.h"

namespace terrazzo {

/// Pixels of a map of an earlier result that must not change.
struct KeptPixels {
  ImagePtr map{};    ///< at the result's scale; null: nothing is kept
  int x = 0, y = 0;  ///< position of its top left pixel in the result; pixels outside are ignored
  ImagePtr holes{};  ///< nothing is kept where its first channel exceeds 0.5; stretched over the result; null: no holes
};

/// Kept pixels in memory. Immutable; thread-safe.
class KeptLookup {
 public:
  /// `result`: its size.
  KeptLookup(const KeptPixels& kept, Size result);

  bool any() const { return map_ != nullptr; }
  /// The kept values of a pixel of the result; null if it is free.
  const float* at(int x, int y) const {
    if (!map_ || x < area_.x || y < area_.y || x >= area_.right() || y >= area_.bottom()) return nullptr;
    const size_t i = size_t(y - area_.y) * size_t(area_.width) + size_t(x - area_.x);
    return !free_.empty() && free_[i] ? nullptr : map_->in_memory() + i * size_t(map_->channels());
  }

 private:
  ImagePtr map_;
  Rect area_;
  std::vector<uint8_t> free_;  ///< 1 where a pixel of the area is free; empty: none is
};

}  // namespace terrazzo
