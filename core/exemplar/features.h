#pragma once

#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "core/exemplar/elements.h"
#include "core/exemplar/repeats.h"
#include "core/image/float_planes.h"
#include "core/image/image.h"

namespace terrazzo {

/// One image's part in the features: its channels in analysis space (perceptual colour, unit normals, plain values),
/// scaled by the weights.
struct FeatureImage {
  ImagePtr image;               ///< already in analysis space
  std::vector<double> weights;  ///< one per channel, >= 0; 0 leaves a channel out
  std::string map{};            ///< its name in the material, if it has one
};

/// Where weighted_planes (core/analysis/space/planes.h) finds what it has made of the same images, if somebody still
/// holds it.
struct HeldPlanes {
  std::mutex mutex;
  std::weak_ptr<const Planes> planes;
};

class Features;
using FeaturesPtr = std::shared_ptr<const Features>;

/// The weighted, concatenated channels of an exemplar, not yet reduced. Images are pulled lazily. Immutable but for
/// held_planes.
class Features {
 public:
  /// All images must have `size`. Throws Error if every weight is 0. `wraps`: the exemplar tiles in x and y. `mask`:
  /// where its first channel exceeds 0.5 the exemplar may be sampled; null: everywhere.
  static FeaturesPtr make(Size size, std::vector<FeatureImage> images, bool wraps, const Repeats& repeats = {},
                          ImagePtr mask = nullptr, ElementsPtr elements = nullptr);
  /// The same features of an exemplar that is known to repeat.
  FeaturesPtr with(const Repeats& repeats) const;
  /// The same features of an exemplar of which only a part may be sampled.
  FeaturesPtr with(ImagePtr mask) const { return make(size_, images_, wraps_, repeats_, std::move(mask), elements_); }
  /// The same features of an exemplar whose elements are known.
  FeaturesPtr with(ElementsPtr elements) const;

  Size size() const { return size_; }
  bool wraps() const { return wraps_; }
  const Repeats& repeats() const { return repeats_; }        ///< of rank 0 unless they have been looked for and found
  const ElementsPtr& elements() const { return elements_; }  ///< null unless they have been looked for and found
  const std::vector<FeatureImage>& images() const { return images_; }
  const ImagePtr& mask() const { return mask_; }  ///< null: all of the exemplar may be sampled
  /// Channels of non-zero weight.
  int channel_count() const;
  const Digest& digest() const { return digest_; }
  /// One for all features that differ in repeats and elements only.
  HeldPlanes& held_planes() const { return *held_planes_; }

 private:
  Features() = default;
  static std::shared_ptr<Features> made(Size size, std::vector<FeatureImage> images, bool wraps, const Repeats& repeats,
                                        ImagePtr mask, ElementsPtr elements);
  FeaturesPtr with(const Repeats& repeats, ElementsPtr elements) const;
  Size size_;
  bool wraps_ = false;
  Repeats repeats_;
  ElementsPtr elements_;
  std::vector<FeatureImage> images_;
  ImagePtr mask_;
  Digest digest_;
  std::shared_ptr<HeldPlanes> held_planes_ = std::make_shared<HeldPlanes>();
};

}  // namespace terrazzo
