#include <doctest/doctest.h>

#include "tests/nodes/image/image_checks.h"

using namespace terrazzo;
using namespace terrazzo::test;

TEST_CASE("channel_split gives stored values as raw data") {
  const ImagePtr image = flat_image({3, 2}, {0.1f, 0.2f, 0.3f}, Semantic::base_color, "srgb_texture");
  const NodeRun run = run_node("channel_split", {}, {{"image", {image}}});
  const std::vector<std::pair<std::string, float>> expected = {{"r", 0.1f}, {"g", 0.2f}, {"b", 0.3f}, {"a", 1.0f}};
  for (const auto& [port, value] : expected) {
    const auto channel = run.get<Image>(port);
    CHECK(channel->channels() == 1);
    CHECK(channel->info().semantic == Semantic::data);
    CHECK(channel->info().color_space == "raw");
    CHECK(channel->pixels() == std::vector<float>(6, value));
  }
}

TEST_CASE("channels that are missing are 0, coverage is 1, and all outputs differ in digest") {
  const NodeRun run = run_node("channel_split", {}, {{"image", {flat_image({2, 2}, {0.4f})}}});
  CHECK(run.get<Image>("g")->pixels().front() == 0);
  CHECK(run.get<Image>("b")->pixels().front() == 0);
  CHECK(run.get<Image>("a")->pixels().front() == 1);
  CHECK(run.get<Image>("g")->digest() != run.get<Image>("r")->digest());
}

TEST_CASE("channel_split is the same in tiles and as a whole") {
  check_every_size([](Size size) {
    return run_node("channel_split", {}, {{"image", {noise_image(size, 3)}}}).get<Image>("b");
  });
}
