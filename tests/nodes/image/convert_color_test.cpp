#include <doctest/doctest.h>

#include "core/image/srgb.h"
#include "tests/nodes/image/image_checks.h"

using namespace terrazzo;
using namespace terrazzo::test;

TEST_CASE("convert_color decodes the sRGB curve and leaves a fourth channel") {
  const ImagePtr image = flat_image({3, 2}, {0.2f, 0.5f, 0.8f, 0.5f}, Semantic::base_color, "srgb_texture");
  const ImagePtr linear = run_image("convert_color", {}, {{"image", image}});
  CHECK(linear->info().color_space == "lin_rec709");
  CHECK(greatest_difference(*linear, *flat_image({3, 2}, {float(decode_srgb(0.2)), float(decode_srgb(0.5)),
                                                          float(decode_srgb(0.8)), 0.5f})) < 1e-5);
  const ImagePtr back = run_image("convert_color", {{"to", "srgb_texture"}}, {{"image", linear}});
  CHECK(greatest_difference(*back, *image) < 1e-5);
}

TEST_CASE("convert_color leaves raw images unless told what they are in") {
  const ImagePtr raw = flat_image({2, 2}, {0.5f, 0.5f, 0.5f}, Semantic::base_color);
  const NodeRun run = run_node("convert_color", {}, {{"image", {raw}}});
  CHECK(run.get<Image>("image") == raw);
  CHECK(run.notes.size() == 1);
  const ImagePtr converted = run_image("convert_color", {{"from", "srgb_texture"}}, {{"image", raw}});
  CHECK(converted->pixels().front() == doctest::Approx(decode_srgb(0.5f)).epsilon(1e-4));
}

TEST_CASE("convert_color is the same in tiles and as a whole") {
  check_every_size([](Size size) {
    return run_image("convert_color", {{"to", "acescg"}},
                     {{"image", noise_image(size, 3, Semantic::base_color, "srgb_texture")}});
  });
}
