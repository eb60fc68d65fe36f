#include <doctest/doctest.h>

#include "core/image/srgb.h"
#include "tests/nodes/image/image_checks.h"

using namespace terrazzo;
using namespace terrazzo::test;

namespace {

float gray(const ImagePtr& image, const Params& params = {}) {
  const ImagePtr result = run_image("grayscale", params, {{"image", image}});
  CHECK(result->channels() == 1);
  CHECK(result->info().semantic == image->info().semantic);
  return result->pixels().front();
}

}  // namespace

TEST_CASE("luminance is taken in linear light for encoded colours") {
  CHECK(gray(flat_image({2, 2}, {0, 1, 0}, Semantic::base_color, "srgb_texture")) ==
        doctest::Approx(encode_srgb(0.7152f)));
  CHECK(gray(flat_image({2, 2}, {0, 1, 0}, Semantic::base_color, "lin_rec709")) == doctest::Approx(0.7152));
  CHECK(gray(flat_image({2, 2}, {0.3f, 0.3f, 0.3f}, Semantic::base_color, "srgb_texture")) == doctest::Approx(0.3));
}

TEST_CASE("averages and weights") {
  const ImagePtr image = flat_image({2, 2}, {0.1f, 0.2f, 0.6f});
  CHECK(gray(image, {{"method", "average"}}) == doctest::Approx(0.3));
  CHECK(gray(image, {{"method", "weights"}, {"weights", Numbers{2.0, 0.0, -0.25}}}) == doctest::Approx(0.05));
  CHECK(gray(flat_image({2, 2}, {0.1f, 0.3f})) == doctest::Approx(0.2));
  CHECK(gray(flat_image({1, 1}, {0.1f, 0.1f, 0.1f, 0.9f}, Semantic::base_color)) == doctest::Approx(0.1));
}

TEST_CASE("grayscale is the same in tiles and as a whole") {
  check_every_size([](Size size) {
    return run_image("grayscale", {}, {{"image", noise_image(size, 4, Semantic::base_color, "srgb_texture")}});
  });
}

TEST_CASE("grayscale says how many weights it wants") {
  CHECK(error_of("grayscale", {{"method", "weights"}}, {{"image", flat_image({2, 2}, {0, 0, 0})}}, "weights")
            .find("expected 3 weights, one for each of the image's channels except alpha; found 1") !=
        std::string::npos);
}
