#pragma once

#include <algorithm>
#include <vector>

#include "core/image/image.h"

namespace terrazzo {

/// The dark background of contact sheets; colours are sRGB, three channels of 0..1. Different pixels may be written
/// from different threads.
class SheetCanvas {
 public:
  static constexpr int channels = 3;

  explicit SheetCanvas(Size size) : size_(size), pixels_(size_t(size.area()) * channels, 0.15f) {}

  Size size() const { return size_; }
  /// Writes `count` pixels, from (x, y) to the right; they must lie on the canvas.
  void put(int x, int y, const float* colors, int count) { std::copy_n(colors, size_t(count) * channels, at(x, y)); }
  /// Fills an area of the canvas with a grey.
  void fill(const Rect& area, float grey) {
    for (int y = area.y; y < area.bottom(); y++) std::fill_n(at(area.x, y), size_t(area.width) * channels, grey);
  }
  /// Converts the canvas to an 8-bit sRGB image and consumes it.
  ImagePtr finished() && {
    const ImageInfo info{.size = size_,
                         .channels = channels,
                         .semantic = Semantic::base_color,
                         .color_space = "srgb_texture",
                         .depth = Depth::u8};
    return Image::from_floats(info, std::move(pixels_));
  }

 private:
  float* at(int x, int y) { return &pixels_[(size_t(y) * size_.width + x) * channels]; }

  Size size_;
  std::vector<float> pixels_;
};

}  // namespace terrazzo
