#include <cmath>

#include <doctest/doctest.h>

#include "core/image/normal.h"
#include "tests/nodes/image/image_checks.h"

using namespace terrazzo;
using namespace terrazzo::test;

TEST_CASE("the normal of a tilted plane is the plane's, with every filter and both conventions") {
  const ImagePtr plane = make_image(
      {9, 9}, 1, [](int x, int y, int) { return 0.05f * float(x) + 0.02f * float(y); }, Semantic::height);
  for (const std::string filter : {"sobel", "scharr", "central"})
    for (const std::string convention : {"up", "down"}) {
      const ImagePtr normals = run_image(
          "make_normal", {{"height_scale", 10.0}, {"filter", filter}, {"normal_y", convention}}, {{"height", plane}});
      CHECK(normals->info().semantic == Semantic::normal);
      CHECK(normals->channels() == 3);
      const NormalY normal_y = convention == "up" ? NormalY::up : NormalY::down;
      CHECK(normals->info().normal_y == normal_y);
      const std::vector<float> p = normals->read({4, 4, 1, 1});
      const Vector3f n = decode_normal(p.data(), normal_y);
      // The plane rises to the right and down the image: its normal leans left and up.
      const double length = std::sqrt(0.5 * 0.5 + 0.2 * 0.2 + 1);
      CHECK(n[0] == doctest::Approx(-0.5 / length).epsilon(1e-4));
      CHECK(n[1] == doctest::Approx(0.2 / length).epsilon(1e-4));
      CHECK(n[2] == doctest::Approx(1 / length).epsilon(1e-4));
      CHECK((p[1] > 0.5f) == (convention == "up"));
    }
}

TEST_CASE("make_normal wraps slopes around when told to") {
  const ImagePtr ramp = make_image(
      {8, 8}, 1, [](int x, int, int) { return float(x); }, Semantic::height);
  const auto first_x = [&](const std::string& edges) {
    return run_image("make_normal", {{"height_scale", 1.0}, {"edges", edges}}, {{"height", ramp}})->pixels().front();
  };
  CHECK(first_x("clamp") < 0.5f);
  CHECK(first_x("wrap") > 0.5f);
}

TEST_CASE("make_normal is the same in tiles and as a whole") {
  for (const std::string edges : {"clamp", "wrap"})
    check_every_size([&](Size size) {
      return run_image("make_normal", {{"edges", edges}}, {{"height", noise_image(size, 1, Semantic::height)}});
    });
}

TEST_CASE("make_normal wants one channel and says what it found") {
  const std::string message =
      error_of("make_normal", {}, {{"height", flat_image({4, 2}, {0, 0, 0}, Semantic::base_color)}}, "height");
  CHECK(message.find("expected an image of 1 channel, found a base_color map of 4x2 pixels and 3 channels") !=
        std::string::npos);
}
