#include "core/resolve/kept_heights.h"

#include "core/image/image_ops.h"

namespace terrazzo {

KeptLookup::KeptLookup(const KeptHeights& kept, Size result) {
  if (!kept.heights) return;
  heights_ = materialized(kept.heights);
  area_ = {kept.x, kept.y, heights_->width(), heights_->height()};
  if (!kept.holes) return;
  free_.assign(size_t(area_.area()), 0);
  const ImagePtr holes = nearest_at_size(kept.holes, result);
  const Rect part = intersect(area_, whole(result));
  for (int y = part.y; y < part.bottom(); y++) {
    const std::vector<float> row = holes->read({part.x, y, part.width, 1});
    for (int x = 0; x < part.width; x++)
      free_[size_t(y - area_.y) * size_t(area_.width) + size_t(part.x + x - area_.x)] =
          row[size_t(x) * size_t(holes->channels())] > 0.5f;
  }
}

}  // namespace terrazzo
