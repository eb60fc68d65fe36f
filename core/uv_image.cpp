#include "core/uv_image.h"

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

}  // namespace terrazzo
