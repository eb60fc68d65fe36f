#include <algorithm>
#include <cmath>

#include <doctest/doctest.h>

#include "tests/nodes/image/image_checks.h"

using namespace terrazzo;
using namespace terrazzo::test;

namespace {

ImagePtr matched(const ImagePtr& image, const ImagePtr& reference, double strength = 1) {
  return run_image("match_histogram", {{"strength", strength}}, {{"image", image}, {"reference", reference}});
}

std::vector<float> sorted_pixels(const Image& image) {
  std::vector<float> p = image.pixels();
  std::sort(p.begin(), p.end());
  return p;
}

}  // namespace

TEST_CASE("an image matched to itself stays, bit for bit") {
  const ImagePtr image = noise_image({31, 17}, 3);
  CHECK(matched(image, image)->pixels() == image->pixels());
}

TEST_CASE("matching gives the reference's distribution and keeps the order of values") {
  // All values differ, so ranks pair up one to one.
  const ImagePtr image =
      make_image({16, 16}, 1, [](int x, int y, int) { return float((x * 16 + y) * 37 % 257) / 257; });
  const ImagePtr reference =
      make_image({16, 16}, 1, [](int x, int y, int) { return std::sqrt(float(x * 16 + y)) - 3; });
  const ImagePtr result = matched(image, reference);
  const std::vector<float> have = sorted_pixels(*image), got = sorted_pixels(*result),
                           wanted = sorted_pixels(*reference);
  REQUIRE(std::adjacent_find(have.begin(), have.end()) == have.end());
  for (size_t i = 0; i < got.size(); i++) CHECK(got[i] == doctest::Approx(wanted[i]).epsilon(1e-3));
  const std::vector<float> p = image->pixels(), q = result->pixels();
  for (size_t i = 1; i < p.size(); i++) CHECK((p[i] < p[i - 1]) == (q[i] < q[i - 1]));
}

TEST_CASE("strength leads from the image to the reference") {
  const ImagePtr image = noise_image({8, 8}, 1), reference = noise_image({9, 5}, 1, Semantic::data, "raw", 7);
  CHECK(matched(image, reference, 0)->pixels() == image->pixels());
  const std::vector<float> full = matched(image, reference, 1)->pixels(),
                           half = matched(image, reference, 0.5)->pixels(), none = image->pixels();
  for (size_t i = 0; i < full.size(); i++) CHECK(half[i] == doctest::Approx(0.5 * (full[i] + none[i])));
}

TEST_CASE("a reference of one value gives that value") {
  for (const float v : matched(noise_image({6, 6}, 1), flat_image({2, 2}, {0.7f}))->pixels()) CHECK(v == 0.7f);
}

TEST_CASE("match_histogram is the same in tiles and on any number of threads") {
  check_every_size([](Size size) {
    return matched(noise_image(size, 3), noise_image({20, 9}, 3, Semantic::data, "raw", 5));
  });
}

TEST_CASE("match_histogram wants as many channels in both") {
  const std::string message =
      error_of("match_histogram", {},
               {{"image", flat_image({2, 2}, {0, 0, 0})}, {"reference", flat_image({5, 4}, {0})}}, "reference");
  CHECK(message.find("found a data map of 5x4 pixels and 1 channel") != std::string::npos);
}
