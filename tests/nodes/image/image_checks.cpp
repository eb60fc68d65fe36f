#include "tests/nodes/image/image_checks.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include <doctest/doctest.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include "core/base/error.h"

namespace terrazzo::test {

namespace {

bool same_bits(const std::vector<float>& a, const std::vector<float>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(float)) == 0;
}

std::map<std::string, std::vector<Value>> as_values(const std::map<std::string, ImagePtr>& images) {
  std::map<std::string, std::vector<Value>> values;
  for (const auto& [port, image] : images) values[port] = {image};
  return values;
}

}  // namespace

ImagePtr noise_image(Size size, int channels, Semantic semantic, const std::string& color_space, unsigned seed) {
  const auto value = [seed](int x, int y, int c) {
    return float(below(uint32_t(random_bits(seed, x, y, c)), 255)) / 255;
  };
  return make_image(size, channels, value, semantic, color_space);
}

ImagePtr flat_image(Size size, const std::vector<float>& pixel, Semantic semantic, const std::string& color_space) {
  return make_image(
      size, int(pixel.size()), [&](int, int, int c) { return pixel[c]; }, semantic, color_space);
}

ImagePtr with_depth(const ImagePtr& image, Depth depth) {
  ImageInfo info = image->info();
  info.depth = depth;
  return Image::redescribed(image, info);
}

ImagePtr run_image(const std::string& type, const Params& params, const std::map<std::string, ImagePtr>& inputs) {
  const NodeRun run = run_node(type, params, as_values(inputs));
  REQUIRE(run.outputs.size() == 1);
  const Value& value = run.outputs.begin()->second;
  if (type_of(value) == ValueType::material) return std::get<MaterialPtr>(value)->maps().front().image;
  return std::get<ImagePtr>(value);
}

std::string error_of(const std::string& type, const Params& params, const std::map<std::string, ImagePtr>& inputs,
                     const std::string& about) {
  try {
    run_node(type, params, as_values(inputs));
  } catch (const Error& e) {
    CHECK(e.about() == about);
    return e.what();
  }
  FAIL_CHECK(type << " threw no error about " << about);
  return "";
}

void check_tiles_agree(const Image& image) {
  const std::vector<float> all = image.pixels();
  const size_t row = size_t(image.width()) * image.channels();
  std::vector<float> tiled(all.size());
  for (int y = 0; y < image.height(); y += 7)
    for (int x = 0; x < image.width(); x += 5) {
      const Rect tile = intersect({x, y, 5, 7}, whole(image.size()));
      const std::vector<float> pixels = image.read(tile);
      const size_t count = size_t(tile.width) * image.channels();
      for (int i = 0; i < tile.height; i++)
        std::copy_n(&pixels[i * count], count, &tiled[(y + i) * row + size_t(x) * image.channels()]);
    }
  CHECK(same_bits(all, tiled));
}

void check_every_size(const std::function<ImagePtr(Size)>& make) {
  for (const Size size : {Size{1, 1}, Size{3, 5}, Size{37, 23}}) {
    CAPTURE(size.width);
    std::vector<float> alone, together;
    tbb::task_arena(1).execute([&] {
      const ImagePtr image = make(size);
      alone = image->pixels();
      check_tiles_agree(*image);
    });
    const tbb::global_control four(tbb::global_control::max_allowed_parallelism, 4);
    tbb::task_arena(4).execute([&] { together = make(size)->pixels(); });
    CHECK(same_bits(alone, together));
    CHECK(std::all_of(alone.begin(), alone.end(), [](float v) { return std::isfinite(v); }));
  }
}

double greatest_difference(const Image& a, const Image& b) {
  REQUIRE(a.size() == b.size());
  REQUIRE(a.channels() == b.channels());
  const std::vector<float> p = a.pixels(), q = b.pixels();
  double most = 0;
  for (size_t i = 0; i < p.size(); i++) most = std::max(most, std::fabs(double(p[i]) - q[i]));
  return most;
}

}  // namespace terrazzo::test
