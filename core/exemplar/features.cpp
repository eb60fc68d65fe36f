#include "core/exemplar/features.h"

#include "core/base/error.h"

namespace terrazzo {

FeaturesPtr Features::make(Size size, std::vector<FeatureImage> images, bool wraps, const Repeats& repeats,
                           ImagePtr mask, ElementsPtr elements) {
  return made(size, std::move(images), wraps, repeats, std::move(mask), std::move(elements));
}

FeaturesPtr Features::with(const Repeats& repeats) const {
  return with(repeats, elements_);
}

FeaturesPtr Features::with(ElementsPtr elements) const {
  return with(repeats_, std::move(elements));
}

FeaturesPtr Features::with(const Repeats& repeats, ElementsPtr elements) const {
  const std::shared_ptr<Features> out = made(size_, images_, wraps_, repeats, mask_, std::move(elements));
  out->held_planes_ = held_planes_;
  return out;
}

std::shared_ptr<Features> Features::made(Size size, std::vector<FeatureImage> images, bool wraps,
                                         const Repeats& repeats, ImagePtr mask, ElementsPtr elements) {
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
