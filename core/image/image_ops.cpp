#include "core/image/image_ops.h"

#include <algorithm>

namespace terrazzo {

ImagePtr nearest_at_size(const ImagePtr& image, Size size) {
  if (image->size() == size) return image;
  ImageInfo info = image->info();
  info.size = size;
  const Digest digest = Hasher().add("at size").add(image->digest()).add(size.width).add(size.height).digest();
  const Size from = image->size();
  const auto source_x = [=](int x) { return int(int64_t{x} * from.width / size.width); };
  const auto source_y = [=](int y) { return int(int64_t{y} * from.height / size.height); };
  const auto reads = [=](size_t, const Rect& r) {
    const int top = source_y(r.y);
    return std::vector<Rect>{{0, top, from.width, source_y(r.bottom() - 1) + 1 - top}};
  };
  const auto compute = [=](std::span<const PixelView> in, const Rect& r, float* out) {
    const int n = in[0].channels();
    std::vector<float> row(size_t(from.width) * n);
    for (int y = r.y; y < r.bottom(); y++) {
      in[0].read({0, source_y(y), from.width, 1}, row.data());
      for (int x = r.x; x < r.right(); x++, out += n) std::copy_n(&row[size_t(source_x(x)) * n], n, out);
    }
  };
  return Image::computed(info, digest, {.sources = {image}, .reads = reads, .compute = compute});
}

ImagePtr pixel_by_pixel(ImageInfo info, const Digest& recipe, std::vector<ImagePtr> inputs, PixelFunction function) {
  const auto compute = [function = std::move(function)](std::span<const PixelView> in, const Rect& region, float* out) {
    std::vector<std::vector<float>> copies;
    std::vector<const float*> pixels;
    copies.reserve(in.size());
    for (const PixelView& view : in) {
      const float* there = view.in_place(region);
      pixels.push_back(there ? there : copies.emplace_back(view.read(region)).data());
    }
    function(pixels, out, region.area());
  };
  return Image::computed(std::move(info), recipe, {.sources = std::move(inputs), .compute = compute});
}

}  // namespace terrazzo
