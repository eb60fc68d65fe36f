#include "core/image/image_ops.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/base/text.h"

namespace terrazzo {

std::string describe(const Image& image) {
  return fmt::format("a {} map of {} pixels and {}", name_of(image.info().semantic), describe(image.size()),
                     counted(image.channels(), "channel"));
}

void require_one_channel(const std::string& port, const Image& image) {
  if (image.channels() == 1) return;
  throw Error(port, fmt::format("expected an image of 1 channel, found {}; put \"grayscale\" or \"channel_split\" "
                                "before it",
                                describe(image)));
}

void require_no_normals(const std::string& port, const Image& image) {
  if (image.info().semantic != Semantic::normal) return;
  throw Error(port,
              fmt::format("expected values that can be changed one by one, found {}: its channels make up "
                          "vectors; use \"blend\" or \"normalize\" for normals, or \"channel_split\" to take them "
                          "apart",
                          describe(image)));
}

void require_same_size(const std::string& port, const Image& image, const std::string& other_port, const Image& other) {
  if (image.size() == other.size()) return;
  throw Error(
      port, fmt::format("expected the same size as \"{}\", {}, found {}; put \"resize\" or \"crop\" before one of them",
                        other_port, describe(other.size()), describe(image.size())));
}

void require_shape(const std::string& port, const Image& image, const std::string& of, Size size) {
  if (same_shape(image.size(), size)) return;
  throw Error(port, fmt::format("expected an image of the shape of {}, {} pixels, at that or any other scale; found {}",
                                of, describe(size), describe(image)));
}

ImagePtr nearest_at_size(const ImagePtr& image, Size size) {
  if (image->size() == size) return image;
  ImageInfo info = image->info();
  info.size = size;
  const Digest digest = Hasher().add("at size").add(image->digest()).add(size.width).add(size.height).digest();
  return Image::computed(info, digest, [image, size](const Rect& r, float* out) {
    const int n = image->channels();
    std::vector<float> row(size_t(image->width()) * n);
    for (int y = 0; y < r.height; y++) {
      image->read({0, int(int64_t{r.y + y} * image->height() / size.height), image->width(), 1}, row.data());
      for (int x = 0; x < r.width; x++, out += n)
        std::copy_n(&row[size_t(int64_t{r.x + x} * image->width() / size.width) * n], n, out);
    }
  });
}

ImagePtr pixel_by_pixel(ImageInfo info, const Digest& recipe, std::vector<ImagePtr> inputs, PixelFunction function) {
  return Image::computed(std::move(info), recipe,
                         [inputs = std::move(inputs), function = std::move(function)](const Rect& region, float* out) {
                           std::vector<std::vector<float>> pixels;
                           std::vector<const float*> pointers;
                           for (const ImagePtr& input : inputs) pixels.push_back(input->read(region));
                           for (const std::vector<float>& p : pixels) pointers.push_back(p.data());
                           function(pointers, out, region.area());
                         });
}

}  // namespace terrazzo
