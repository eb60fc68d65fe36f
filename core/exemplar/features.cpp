#include "core/exemplar/features.h"

#include "core/base/error.h"

namespace terrazzo {

FeaturesPtr Features::make(Size size, std::vector<FeatureImage> images, bool wraps, const Repeats& repeats,
                           ImagePtr mask, ElementsPtr elements) {
  Hasher h;
  h.add("features").add(size.width).add(size.height).add(wraps).add(int64_t(images.size()));
  repeats.add_to(h);
  if (mask && mask->size() != size) throw std::logic_error("the mask needs the features' size");
  if (mask) h.add(mask->digest());
  if (elements && elements->size != size) throw std::logic_error("elements need the features' size");
  if (elements) elements->add_to(h.add("elements"));
  bool any = false;
  for (const FeatureImage& f : images) {
    if (f.image->size() != size || int(f.weights.size()) != f.image->channels())
      throw std::logic_error("feature images need one size and a weight per channel");
    h.add(f.map).add(f.image->digest());
    for (const double w : f.weights) {
      h.add(w);
      any |= w > 0;
    }
  }
  if (!any)
    throw Error("weights",
                "every map has weight 0, so nothing is left to compare; give at least one a positive weight");
  auto features = std::shared_ptr<Features>(new Features);
  features->size_ = size;
  features->wraps_ = wraps;
  features->repeats_ = repeats;
  features->elements_ = std::move(elements);
  features->images_ = std::move(images);
  features->mask_ = std::move(mask);
  features->digest_ = h.digest();
  return features;
}

int Features::channel_count() const {
  int count = 0;
  for (const FeatureImage& f : images_)
    for (const double w : f.weights) count += w > 0;
  return count;
}

}  // namespace terrazzo
