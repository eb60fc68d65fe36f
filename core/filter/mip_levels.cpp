#include "core/filter/mip_levels.h"

#include <algorithm>

#include "core/base/hash.h"
#include "core/filter/opacity_weights.h"
#include "core/filter/resample.h"
#include "core/image/pixel_buffer.h"
#include "core/image/pixel_space.h"

namespace terrazzo {

namespace {

class KeptSource final : public PixelSource {
 public:
  explicit KeptSource(const Image& image) : pixels_(image.size(), image.channels()) {
    for_each_strip(image, [&](const Rect& r, const float* p) { pixels_.write_rows(r.y, r.height, p); });
  }
  void read(const Rect& region, float* out) const override { pixels_.read(region, out); }

 private:
  PixelBuffer pixels_;
};

ImagePtr kept(const ImagePtr& image) {
  if (image->in_memory()) return image;
  return Image::with_digest(image->info(), image->digest(), std::make_shared<KeptSource>(*image));
}

Size half(Size size) {
  return {std::max(1, size.width / 2), std::max(1, size.height / 2)};
}

std::vector<ImagePtr> halved_to_one(const ImagePtr& image, const std::string& filter) {
  const Digest recipe = Hasher().add("mip level").digest();
  std::vector<ImagePtr> levels = {kept(image)};
  while (levels.back()->size().area() > 1)
    levels.push_back(kept(resampled(levels.back(), half(levels.back()->size()), filter, Outside::wrap, recipe)));
  return levels;
}

/// Filled from the smallest level up, so that visible colours spread into transparent pixels.
std::vector<ImagePtr> weighted_levels(const ImagePtr& image, const ImagePtr& weights) {
  std::vector<ImagePtr> levels = halved_to_one(premultiplied(image, weights), "box");
  ImagePtr coarser;
  for (size_t i = levels.size(); i-- > 1;) {
    ImageInfo info = image->info();
    info.size = levels[i]->size();
    coarser = levels[i] = kept(unpremultiplied(levels[i], info, coarser));
  }
  levels.front() = kept(image);
  return levels;
}

}  // namespace

std::vector<ImagePtr> mip_levels(const ImagePtr& image, const ImagePtr& weights) {
  if (weights) return weighted_levels(image, weights);
  const bool is_label = !can_be_averaged(image->info()) || image->info().semantic == Semantic::data;
  return halved_to_one(image, is_label ? "nearest" : "box");
}

int mip_level_count(Size size) {
  int count = 1;
  for (; size.area() > 1; size = half(size)) count++;
  return count;
}

}  // namespace terrazzo
