#include "core/exemplar/uv_image.h"

#include <cmath>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/base/text.h"

namespace terrazzo {

namespace {

template <typename Encode>
ImagePtr encoded(const UvMapPtr& uv, int channels, Depth depth, const char* recipe, Encode encode) {
  ImageInfo info{.size = uv->size(), .channels = channels, .semantic = Semantic::data, .depth = depth};
  return Image::computed(info, Hasher().add(recipe).add(uv->digest()).digest(),
                         [uv, channels, encode](const Rect& region, float* out) {
                           std::vector<ExemplarPixel> pixels(region.area());
                           uv->read(region, pixels.data());
                           for (size_t i = 0; i < pixels.size(); i++) encode(pixels[i], out + i * channels);
                         });
}

}  // namespace

ImagePtr uv_as_fractions(const UvMapPtr& uv) {
  const Size e = uv->exemplar();
  return encoded(uv, 2, Depth::f32, "uv as fractions", [e](ExemplarPixel p, float* out) {
    out[0] = float((p.x + 0.5) / e.width);
    out[1] = float((p.y + 0.5) / e.height);
  });
}

ImagePtr uv_as_integers(const UvMapPtr& uv) {
  return encoded(uv, 3, Depth::u16, "uv as integers", [](ExemplarPixel p, float* out) {
    out[0] = float(p.x) / 65535.0f;
    out[1] = float(p.y) / 65535.0f;
    out[2] = 0;
  });
}

UvMapPtr uv_from_image(const Image& image, Size exemplar, UvWraps wraps) {
  const bool fractions = image.info().depth == Depth::f32;
  if (image.channels() < 2 || (!fractions && image.info().depth != Depth::u16))
    throw Error(fmt::format("expected a uv map, of two float channels or 16-bit red and green; found {} of {}",
                            counted(image.channels(), "channel"), name_of(image.info().depth)));
  const double width = fractions ? exemplar.width : 65535, height = fractions ? exemplar.height : 65535;
  std::vector<ExemplarPixel> pixels;
  pixels.reserve(size_t(image.size().area()));
  for_each_strip(image, [&](const Rect& strip, const float* values) {
    for (int64_t i = 0; i < strip.area(); i++, values += image.channels()) {
      const double x = std::floor(values[0] * width + (fractions ? 0 : 0.5));
      const double y = std::floor(values[1] * height + (fractions ? 0 : 0.5));
      if (!(x >= 0 && y >= 0 && x < exemplar.width && y < exemplar.height))
        throw Error(
            fmt::format("the uv map refers to pixel ({}, {}), outside the exemplar of {}x{} pixels; connect the "
                        "exemplar it was made for",
                        x, y, exemplar.width, exemplar.height));
      pixels.push_back({uint16_t(x), uint16_t(y)});
    }
  });
  return UvMap::make(image.size(), exemplar, std::move(pixels), wraps);
}

}  // namespace terrazzo
