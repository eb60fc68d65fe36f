#include "core/resolve/kept_pixels.h"

#include "core/image/image_ops.h"

namespace terrazzo {

KeptLookup::KeptLookup(const KeptPixels& kept, Size result) {
  if (!kept.map) return;
  map_ = materialized(kept.map);
  area_ = {kept.x, kept.y, map_->width(), map_->height()};
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
