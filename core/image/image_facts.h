#pragma once

#include <optional>
#include <string>

#include "core/image/image.h"

/// What is known of an image before its pixels are, and the checks that need no more: nodes make them while a graph is
/// planned and again when they run, with the same messages. Thread-safe.
namespace terrazzo {

/// The description of an image as far as it is known; what is empty is not.
struct ImageFacts {
  std::optional<Size> size{};     ///< in pixels
  std::optional<int> channels{};  ///< 1..4
  std::optional<Semantic> semantic{};
  std::optional<std::string> color_space{};
  bool operator==(const ImageFacts&) const = default;
};
ImageFacts facts_of(const ImageInfo& info);

/// Whether an image of that description may be what the facts say.
bool agrees(const ImageFacts& facts, const ImageInfo& info);

/// "a height map of 256x128 pixels and 1 channel"; without what is not known, "an image of 3 channels".
std::string describe(const ImageFacts& image);

/// The channels that carry values (see core/image/pixel_space.h), if that is known.
std::optional<int> value_channels(const ImageFacts& image);

/// Throws Error about `port` if the image certainly has another number of channels than one.
void require_one_channel(const std::string& port, const ImageFacts& image);
/// Throws Error about `port` if the image certainly holds normals, whose channels mean nothing by themselves.
void require_no_normals(const std::string& port, const ImageFacts& image);
/// Throws Error about `port` if the image is certainly no normal map of three channels or more.
void require_normals(const std::string& port, const ImageFacts& image);
/// Throws Error about `port` if the images certainly differ in size.
void require_same_size(const std::string& port, const ImageFacts& image, const std::string& other_port,
                       const ImageFacts& other);
/// Throws Error about `port` if the image certainly has another shape than what it belongs to, to a pixel.
void require_shape(const std::string& port, const ImageFacts& image, const std::string& of, std::optional<Size> size);

/// The same for images that are there.
inline std::string describe(const Image& image) {
  return describe(facts_of(image.info()));
}
inline void require_one_channel(const std::string& port, const Image& image) {
  require_one_channel(port, facts_of(image.info()));
}
inline void require_shape(const std::string& port, const Image& image, const std::string& of, Size size) {
  require_shape(port, facts_of(image.info()), of, size);
}

}  // namespace terrazzo
