#pragma once

#include <optional>
#include <string>

#include "core/image/image.h"

/// What is known of an image before its pixels are computed, and checks that need nothing else. Nodes use them both
/// while a graph is planned and when they run, so messages are the same. Thread-safe.
namespace terrazzo {

/// The known part of an image's description. Empty members are unknown.
struct ImageFacts {
  std::optional<Size> size{};     ///< in pixels
  std::optional<int> channels{};  ///< 1..4
  std::optional<Semantic> semantic{};
  std::optional<std::string> color_space{};
  bool operator==(const ImageFacts&) const = default;
};
ImageFacts facts_of(const ImageInfo& info);

/// Whether the description agrees with the facts.
bool agrees(const ImageFacts& facts, const ImageInfo& info);

/// "a height map of 256x128 pixels and 1 channel"; unknown facts are left out: "an image of 3 channels".
std::string describe(const ImageFacts& image);

/// The number of channels that carry values (see core/image/pixel_space.h), if known.
std::optional<int> value_channels(const ImageFacts& image);

/// Throws Error about `port` if the image is known to have more than one channel.
void require_one_channel(const std::string& port, const ImageFacts& image);
/// Throws Error about `port` if the image is known to hold normals, whose channels mean nothing individually.
void require_no_normals(const std::string& port, const ImageFacts& image);
/// Throws Error about `port` if the image is known not to be a normal map of at least three channels.
void require_normals(const std::string& port, const ImageFacts& image);
/// Throws Error about `port` if the sizes are known to differ.
void require_same_size(const std::string& port, const ImageFacts& image, const std::string& other_port,
                       const ImageFacts& other);
/// Throws Error about `port` if the image's aspect ratio is known to differ by more than a pixel from that of `size`,
/// the size of `of`.
void require_shape(const std::string& port, const ImageFacts& image, const std::string& of, std::optional<Size> size);

/// The same for images.
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
