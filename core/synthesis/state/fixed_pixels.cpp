#include "core/synthesis/state/fixed_pixels.h"

#include <algorithm>

#include "core/base/bounds.h"

namespace terrazzo {

LatticeGaps ExistingPixels::gaps(Size output) const {
  if (empty()) return {};
  const Rect kept = bounds(output, [&](size_t i) { return keep[i] == Keep::always; });
  if (kept.area() == 0) return {};
  return {{double(kept.right()), double(output.width - kept.width)},
          {double(kept.bottom()), double(output.height - kept.height)}};
}

FixedPixels::FixedPixels(const ExistingPixels& kept, Size output, int level, Size exemplar) {
  if (kept.empty()) return;
  const int block = 1 << level, middle = block / 2;
  const Size size{(output.width + block - 1) / block, (output.height + block - 1) / block};
  fixed_.assign(size_t(size.area()), 1);
  pixels_.resize(fixed_.size());
  begin_.resize(fixed_.size());
  for (int y = 0; y < output.height; y++)
    for (int x = 0; x < output.width; x++)
      if (kept.keep[size_t(y) * output.width + x] != Keep::always)
        fixed_[size_t(y / block) * size.width + x / block] = 0;
  for (int y = 0; y < size.height; y++)
    for (int x = 0; x < size.width; x++) {
      // The finest pixel in the middle stands for the block.
      const int u = std::min(x * block + middle, output.width - 1), v = std::min(y * block + middle, output.height - 1);
      const size_t below = size_t(v) * output.width + u;
      const ExemplarPixel p = kept.pixels[below];
      begin_[size_t(y) * size.width + x] = kept.keep[below] != Keep::never;
      pixels_[size_t(y) * size.width + x] = {uint16_t(std::min(p.x / block, exemplar.width - 1)),
                                             uint16_t(std::min(p.y / block, exemplar.height - 1))};
    }
}

void FixedPixels::put(const std::vector<uint8_t>& which, Field& field, const PlaneWindow& window) const {
  if (!any()) return;
  for (int row = 0; row < field.size.height; row++)
    for (int column = 0; column < field.size.width; column++) {
      const size_t pixel = window.index(column, row);
      if (which[pixel]) field.at(column, row) = pixels_[pixel];
    }
}

void FixedPixels::apply(Field& field, const PlaneWindow& window) const {
  put(fixed_, field, window);
}

void FixedPixels::begin(Field& field, const PlaneWindow& window) const {
  put(begin_, field, window);
  put(fixed_, field, window);
}

}  // namespace terrazzo
