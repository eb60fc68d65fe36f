#include "core/filter/mip_levels.h"

#include <cmath>
#include <filesystem>

#include <OpenImageIO/imageio.h>
#include <doctest/doctest.h>

#include "core/image/srgb.h"
#include "core/image_io/image_file.h"
#include "tests/run_node.h"

using namespace terrazzo;
using namespace terrazzo::test;

namespace {

ImagePtr image_of(Size size, Semantic semantic, const std::string& space,
                  const std::vector<std::vector<float>>& pixels) {
  const int channels = int(pixels.front().size());
  return make_image(
      size, channels,
      [&](int x, int y, int c) { return pixels[size_t(y * size.width + x) % pixels.size()][size_t(c)]; }, semantic,
      space);
}

std::vector<float> decoded(const float* n) {
  return {n[0] * 2 - 1, n[1] * 2 - 1, n[2] * 2 - 1};
}

}  // namespace

TEST_CASE("each level has half the sides, down to one pixel") {
  std::vector<Size> sizes;
  for (const ImagePtr& l : mip_levels(image_of({11, 4}, Semantic::height, "raw", {{0.5f}}))) sizes.push_back(l->size());
  CHECK(sizes == std::vector<Size>{{11, 4}, {5, 2}, {2, 1}, {1, 1}});
  CHECK(mip_level_count({11, 4}) == 4);
  CHECK(mip_level_count({1, 1}) == 1);
  CHECK(mip_level_count({4096, 4096}) == 13);
}

TEST_CASE("a height is averaged as stored, a colour in linear light, labels and masks are sampled") {
  const auto last = [](Semantic s, const std::string& space) {
    return mip_levels(image_of({2, 2}, s, space, {{0.0f, 0, 0}, {1.0f, 1, 1}})).back()->pixels()[0];
  };
  CHECK(last(Semantic::height, "raw") == doctest::Approx(0.5));
  CHECK(last(Semantic::base_color, "lin_rec709") == doctest::Approx(0.5));
  CHECK(last(Semantic::base_color, "srgb_texture") == doctest::Approx(encode_srgb(0.5f)));
  for (const Semantic s : {Semantic::mask, Semantic::data, Semantic::guidance})
    CHECK((last(s, "raw") == 0.0f || last(s, "raw") == 1.0f));
}

TEST_CASE("averaged normals are unit vectors") {
  const float tilt = std::sin(0.6f) * 0.5f, up = std::cos(0.6f) * 0.5f + 0.5f;
  const ImagePtr normals =
      image_of({4, 4}, Semantic::normal, "raw", {{0.5f + tilt, 0.5f, up}, {0.5f - tilt, 0.5f, up}});
  for (const ImagePtr& level : mip_levels(normals)) {
    if (level->width() == 4) continue;
    const std::vector<float> n = decoded(level->pixels().data());
    CHECK(n[0] == doctest::Approx(0).epsilon(1e-6));
    CHECK(n[2] == doctest::Approx(1).epsilon(1e-6));
  }
}

TEST_CASE("an odd side loses nothing: the mean stays") {
  std::vector<std::vector<float>> pixels;
  for (int i = 0; i < 35; i++) pixels.push_back({float(i * 7 % 11) / 11});
  double mean = 0;
  for (const auto& p : pixels) mean += p[0] / 35;
  const auto levels = mip_levels(image_of({7, 5}, Semantic::height, "raw", pixels));
  CHECK(levels.back()->pixels()[0] == doctest::Approx(mean).epsilon(0.02));
}

TEST_CASE("a TX file has tiles and every level, as texture systems take it") {
  const TemporaryFolder folder;
  const std::string path = (folder.path() / "normal.tx").string();
  const ImagePtr image = make_image(
      {200, 130}, 3,
      [](int x, int y, int c) {
        const float nx = 0.4f * std::sin(float(x) * 0.9f), ny = 0.4f * std::cos(float(y) * 1.3f);
        const float length = std::sqrt(nx * nx + ny * ny + 1);
        return (c == 0 ? nx : c == 1 ? ny : 1) / length * 0.5f + 0.5f;
      },
      Semantic::normal);
  std::vector<ImagePtr> levels = mip_levels(image);
  levels.erase(levels.begin());
  for (const Depth depth : {Depth::u8, Depth::u16, Depth::f16, Depth::f32}) {
    CAPTURE(name_of(depth));
    write_image(*image, path, {.format = FileFormat::tx, .depth = depth, .levels = levels}, [](double) {});
    const auto in = OIIO::ImageInput::open(path);
    REQUIRE(in);
    CHECK(in->spec().tile_width == 64);
    CHECK(in->spec().get_string_attribute("textureformat") == "Plain Texture");
    int found = 0;
    double bias = 0;
    for (int level = 0; in->seek_subimage(0, level); level++, found++) {
      const OIIO::ImageSpec& spec = in->spec();
      std::vector<float> pixels(spec.image_pixels() * 3);
      REQUIRE(in->read_image(0, level, 0, 3, OIIO::TypeDesc::FLOAT, pixels.data()));
      const std::vector<float> expected = level == 0 ? image->pixels() : levels[size_t(level - 1)]->pixels();
      REQUIRE(pixels.size() == expected.size());
      double error = 0, sum = 0;
      for (size_t i = 0; i < pixels.size(); i++) error = std::max(error, std::abs(double(pixels[i]) - expected[i]));
      // Half a step of 8 bits; values that are cut off instead of rounded are off by a whole one.
      CHECK(error <= (depth == Depth::u8 ? 0.501 / 255 : 0.001));
      for (size_t i = 0; i < pixels.size(); i += 3) {
        const std::vector<float> n = decoded(&pixels[i]);
        sum += std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]) - 1;
      }
      bias = std::max(bias, std::abs(sum / double(spec.image_pixels())));
    }
    CHECK(found == mip_level_count(image->size()));
    CHECK(bias < (depth == Depth::u8 ? 0.005 : 0.001));
    CHECK(read_image(path, {}, [](const std::string& w) { FAIL(w); })->size() == Size{200, 130});
  }
}
