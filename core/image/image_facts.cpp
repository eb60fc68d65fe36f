#include "core/image/image_facts.h"

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/image/pixel_space.h"

namespace terrazzo {

ImageFacts facts_of(const ImageInfo& info) {
  return {info.size, info.channels, info.semantic, info.color_space};
}

bool agrees(const ImageFacts& facts, const ImageInfo& info) {
  return facts.size.value_or(info.size) == info.size && facts.channels.value_or(info.channels) == info.channels &&
         facts.semantic.value_or(info.semantic) == info.semantic &&
         facts.color_space.value_or(info.color_space) == info.color_space;
}

std::string describe(const ImageFacts& image) {
  std::string out = "an image";
  if (image.semantic) {
    const std::string_view name = name_of(*image.semantic);
    const bool is_vowel = std::string_view("aeiou").find(name.front()) != std::string_view::npos;
    out = fmt::format("{} {} map", is_vowel ? "an" : "a", name);
  }
  if (image.size) out += fmt::format(" of {} pixels", describe(*image.size));
  if (image.channels) out += fmt::format("{}{}", image.size ? " and " : " of ", counted(*image.channels, "channel"));
  return out;
}

std::optional<int> value_channels(const ImageFacts& image) {
  if (!image.channels || (!image.semantic && *image.channels % 2 == 0)) return std::nullopt;
  ImageInfo info;
  info.channels = *image.channels;
  info.semantic = image.semantic.value_or(Semantic::base_color);
  return value_channels(info);
}

void require_one_channel(const std::string& port, const ImageFacts& image) {
  if (image.channels.value_or(1) == 1) return;
  throw Error(port, fmt::format("expected an image of 1 channel, found {}; put \"grayscale\" or \"channel_split\" "
                                "before it",
                                describe(image)));
}

void require_no_normals(const std::string& port, const ImageFacts& image) {
  if (image.semantic != Semantic::normal) return;
  throw Error(port, fmt::format("expected independent channels, found {}: its channels form vectors; use \"blend\" or "
                                "\"normalize\" for normals, or \"channel_split\" to take them apart",
                                describe(image)));
}

void require_normals(const std::string& port, const ImageFacts& image) {
  if (image.semantic.value_or(Semantic::normal) == Semantic::normal && image.channels.value_or(3) >= 3) return;
  throw Error(port, fmt::format("expected a normal map of 3 channels, found {}", describe(image)));
}

void require_same_size(const std::string& port, const ImageFacts& image, const std::string& other_port,
                       const ImageFacts& other) {
  if (!image.size || !other.size || *image.size == *other.size) return;
  throw Error(
      port, fmt::format("expected the same size as \"{}\", {}, found {}; put \"resize\" or \"crop\" before one of them",
                        other_port, describe(*other.size), describe(*image.size)));
}

void require_shape(const std::string& port, const ImageFacts& image, const std::string& of, std::optional<Size> size) {
  if (!image.size || !size || same_shape(*image.size, *size)) return;
  throw Error(port, fmt::format("expected an image with the aspect ratio of {}, {} pixels, at any scale; found {}", of,
                                describe(*size), describe(image)));
}

}  // namespace terrazzo
