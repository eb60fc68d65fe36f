#include "core/image/srgb.h"
#include "core/image_io/color.h"

// Only operations that give the same bits everywhere are used here.
namespace terrazzo {

namespace {

double cube_root(double x) {
  if (x == 0) return 0;
  return x > 0 ? portable::root<3>(x) : -portable::root<3>(-x);
}

double as_linear(float v) {
  return v;
}

double rounded_linear(float v) {
  const double scaled = double(v) * 65536.0;
  if (!(scaled > -0x1p52 && scaled < 0x1p52)) return v;
  return double(int64_t(scaled + (scaled < 0 ? -0.5 : 0.5))) / 65536.0;
}

void oklab(double r, double g, double b, float* out) {
  const double l = cube_root(0.4122214708 * r + 0.5363325363 * g + 0.0514459929 * b);
  const double m = cube_root(0.2119034982 * r + 0.6806995451 * g + 0.1073969566 * b);
  const double s = cube_root(0.0883024619 * r + 0.2817188376 * g + 0.6299787005 * b);
  out[0] = float(0.2104542553 * l + 0.7936177850 * m - 0.0040720468 * s);
  out[1] = float(1.9779984951 * l - 2.4285922050 * m + 0.4505937099 * s);
  out[2] = float(0.0259040371 * l + 0.7827717662 * m - 0.8086757660 * s);
}

template <double (*decode)(float)>
void convert(const float* in, int channels, size_t pixels, float* out) {
  for (size_t i = 0; i < pixels; i++) {
    const float* p = in + i * channels;
    if (channels < 3)
      out[i] = float(cube_root(decode(p[0])));
    else
      oklab(decode(p[0]), decode(p[1]), decode(p[2]), out + 3 * i);
  }
}

}  // namespace

ImagePtr to_oklab(const ImagePtr& image, const std::string& config) {
  ImagePtr source = image;
  auto converter = convert<decode_srgb>;
  const std::string& space = image->info().color_space;
  if (space == "lin_rec709") {
    converter = convert<as_linear>;
  } else if (space != "srgb_texture" && space != "raw") {
    source = convert_color(image, "lin_rec709", config);
    converter = convert<rounded_linear>;
  }
  ImageInfo info = image->info();
  info.channels = info.channels < 3 ? 1 : 3;
  info.color_space = "raw";
  info.depth = Depth::f32;
  const Digest recipe = Hasher().add("oklab 2").add(source->digest()).digest();
  const auto compute = [converter](std::span<const PixelView> in, const Rect& region, float* out) {
    const std::vector<float> pixels = in[0].read(region);
    converter(pixels.data(), in[0].channels(), size_t(region.area()), out);
  };
  return Image::computed(info, recipe, {.sources = {source}, .compute = compute, .work = 20});
}

}  // namespace terrazzo
