#include <cmath>

#include <doctest/doctest.h>

#include "core/image/normal.h"
#include "tests/nodes/image/image_checks.h"

using namespace terrazzo;
using namespace terrazzo::test;

namespace {

ImagePtr converted(const ImagePtr& normal, const std::string& normal_y, bool renormalize = false) {
  return run_image("convert_normal", {{"normal_y", normal_y}, {"renormalize", renormalize}}, {{"normal", normal}});
}

/// Every step of a file in the green channel.
ImagePtr every_step(Depth depth, NormalY normal_y) {
  const int steps = depth == Depth::u8 ? 255 : 65535;
  ImageInfo info{.size = {steps + 1, 1}, .channels = 3, .semantic = Semantic::normal, .depth = depth};
  info.normal_y = normal_y;
  std::vector<float> pixels;
  for (int i = 0; i <= steps; i++)
    for (const int step : {steps / 3, i, steps - 1}) pixels.push_back(float(step) / float(steps));
  return Image::from_floats(info, std::move(pixels));
}

}  // namespace

TEST_CASE("a map in that convention already is left alone to the bit") {
  for (const NormalY normal_y : {NormalY::up, NormalY::down}) {
    const ImagePtr map = every_step(Depth::u8, normal_y);
    const ImagePtr same = converted(map, normal_y == NormalY::up ? "up" : "down");
    CHECK(same->info() == map->info());
    CHECK(same->pixels() == map->pixels());
  }
}

TEST_CASE("green is reversed to the opposite step of the file, and comes back exactly, in 8 and 16 bits") {
  for (const Depth depth : {Depth::u8, Depth::u16}) {
    const ImagePtr up = every_step(depth, NormalY::up), down = converted(up, "down");
    CHECK(down->info().normal_y == NormalY::down);
    CHECK(down->info().depth == depth);
    const std::vector<float> before = up->pixels(), after = down->pixels();
    const size_t count = size_t(up->width());
    for (size_t i = 0; i < count; i++) {
      REQUIRE(after[3 * i] == before[3 * i]);
      REQUIRE(after[3 * i + 1] == before[3 * (count - 1 - i) + 1]);
      REQUIRE(after[3 * i + 2] == before[3 * i + 2]);
    }
    CHECK(converted(down, "up")->pixels() == before);
  }
}

TEST_CASE("the vectors stay the same") {
  const ImagePtr up = noise_image({16, 9}, 3, Semantic::normal), down = converted(up, "down");
  for (int x = 0; x < 16; x++) {
    const std::vector<float> p = up->read({x, 4, 1, 1}), q = down->read({x, 4, 1, 1});
    CHECK((decode_normal(p.data(), NormalY::up) - decode_normal(q.data(), NormalY::down)).norm() < 1e-6f);
  }
}

TEST_CASE("vectors become unit length where that is asked for, flipped or not") {
  const ImagePtr map = flat_image({2, 2}, {0.75f, 0.5f, 0.5f}, Semantic::normal);
  CHECK(converted(map, "up")->pixels() == map->pixels());
  for (const std::string normal_y : {"up", "down"}) {
    const std::vector<float> p = converted(map, normal_y, true)->read({0, 0, 1, 1});
    CHECK(p[0] == 1);
    CHECK(p[1] == 0.5f);
    CHECK(p[2] == 0.5f);
  }
}

TEST_CASE("convert_normal is the same in tiles, and keeps alpha") {
  check_every_size([](Size size) { return converted(noise_image(size, 4, Semantic::normal), "down", true); });
  CHECK(converted(flat_image({1, 1}, {0.5f, 0.25f, 0.75f, 0.3f}, Semantic::normal), "down")->pixels() ==
        std::vector<float>{0.5f, 0.75f, 0.75f, 0.3f});
}

TEST_CASE("convert_normal wants normals") {
  CHECK(error_of("convert_normal", {}, {{"normal", flat_image({4, 2}, {0, 0, 0}, Semantic::base_color)}}, "normal")
            .find("expected a normal map of 3 channels, found a base_color map") != std::string::npos);
}
