#include <doctest/doctest.h>

#include "tests/nodes/image/image_checks.h"

using namespace terrazzo;
using namespace terrazzo::test;

TEST_CASE("channel_pack undoes channel_split") {
  const ImagePtr image = noise_image({13, 8}, 4);
  const NodeRun split = run_node("channel_split", {}, {{"image", {image}}});
  const ImagePtr packed = run_image("channel_pack", {},
                                    {{"r", split.get<Image>("r")},
                                     {"g", split.get<Image>("g")},
                                     {"b", split.get<Image>("b")},
                                     {"a", split.get<Image>("a")}});
  CHECK(packed->pixels() == image->pixels());
}

TEST_CASE("channel_pack takes the channels asked for and fills the rest") {
  const ImagePtr color = with_depth(flat_image({2, 2}, {0.1f, 0.2f, 0.3f}), Depth::u8);
  const ImagePtr gray = with_depth(flat_image({2, 2}, {0.9f}), Depth::u16);
  const ImagePtr packed = run_image("channel_pack",
                                    {{"from", TextMap{{"r", "b"}}},
                                     {"fill", NumberMap{{"a", {1.0}}}},
                                     {"semantic", "base_color"},
                                     {"color_space", "srgb_texture"}},
                                    {{"r", color}, {"b", gray}});
  CHECK(packed->channels() == 4);
  CHECK(packed->read({0, 0, 1, 1}) == std::vector<float>{0.3f, 0, 0.9f, 1});
  CHECK(packed->info().depth == Depth::u16);
  CHECK(packed->info().semantic == Semantic::base_color);
  CHECK(packed->info().color_space == "srgb_texture");
  CHECK(run_image("channel_pack", {}, {{"g", gray}})->channels() == 2);
}

TEST_CASE("channel_pack is the same in tiles and as a whole") {
  check_every_size([](Size size) {
    return run_image("channel_pack", {{"from", TextMap{{"b", "g"}}}},
                     {{"r", noise_image(size, 1)}, {"b", noise_image(size, 3)}});
  });
}

TEST_CASE("channel_pack states sizes and channels that do not fit") {
  const ImagePtr small = flat_image({2, 3}, {0}), large = flat_image({4, 4}, {0});
  CHECK(error_of("channel_pack", {}, {{"r", large}, {"g", small}}, "g").find("4x4, found 2x3") != std::string::npos);
  CHECK(error_of("channel_pack", {{"from", TextMap{{"r", "g"}}}}, {{"r", small}}, "from").find("one of r,") !=
        std::string::npos);
  CHECK(error_of("channel_pack", {{"fill", NumberMap{{"a", {1.0}}}}}, {}, "r").find("at least one") !=
        std::string::npos);
  CHECK(error_of("channel_pack", {{"fill", NumberMap{{"a", {1.0, 2.0}}}}}, {{"r", small}}, "fill").find("found 2") !=
        std::string::npos);
}
