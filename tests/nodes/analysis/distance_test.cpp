#include <cmath>

#include <doctest/doctest.h>

#include "tests/nodes/image/image_checks.h"

using namespace terrazzo;
using namespace terrazzo::test;

namespace {

/// One set pixel at (2, 3).
ImagePtr speck() {
  return make_image(
      {16, 12}, 1, [](int x, int y, int) { return x == 2 && y == 3 ? 1.f : 0.2f; }, Semantic::mask);
}

}  // namespace

TEST_CASE("distance is Euclidean, straight or around the borders") {
  const ImagePtr straight = run_image("distance", {}, {{"mask", speck()}});
  CHECK(straight->info().semantic == Semantic::guidance);
  const ImagePtr around = run_image("distance", {{"edges", std::string("wrap")}}, {{"mask", speck()}});
  for (int y = 0; y < 12; y++)
    for (int x = 0; x < 16; x++) {
      const double dx = std::abs(x - 2), dy = std::abs(y - 3);
      CHECK(straight->read({x, y, 1, 1}).front() == float(std::hypot(dx, dy)));
      CHECK(around->read({x, y, 1, 1}).front() == float(std::hypot(std::min(dx, 16 - dx), std::min(dy, 12 - dy))));
    }
}

TEST_CASE("distance keeps to its limit and comes in parts of it") {
  const ImagePtr limited = run_image("distance", {{"limit", 4.0}}, {{"mask", speck()}});
  CHECK(limited->read({5, 3, 1, 1}).front() == 3);
  CHECK(limited->read({15, 3, 1, 1}).front() == 4);
  const ImagePtr parts = run_image("distance", {{"limit", 4.0}, {"normalized", true}}, {{"mask", speck()}});
  CHECK(parts->read({5, 3, 1, 1}).front() == 0.75f);
  CHECK(parts->read({15, 3, 1, 1}).front() == 1);
  const ImagePtr of_greatest = run_image("distance", {{"normalized", true}}, {{"mask", speck()}});
  CHECK(of_greatest->read({15, 11, 1, 1}).front() == 1);
  CHECK(of_greatest->read({2, 3, 1, 1}).front() == 0);
}

TEST_CASE("signed distance is negative inside, by half a pixel on either side of the outline") {
  const ImagePtr band = make_image({20, 6}, 1, [](int x, int, int) { return x < 8 ? 0.6f : 0.f; });
  const ImagePtr d = run_image("distance", {{"signed", true}}, {{"mask", band}});
  CHECK(d->read({5, 2, 5, 1}) == std::vector<float>{-2.5f, -1.5f, -0.5f, 0.5f, 1.5f});
  const ImagePtr parts =
      run_image("distance", {{"signed", true}, {"limit", 2.0}, {"normalized", true}}, {{"mask", band}});
  CHECK(parts->read({0, 0, 1, 1}).front() == -1);
  CHECK(parts->read({8, 0, 1, 1}).front() == 0.25f);
}

TEST_CASE("the threshold decides what is set, and a mask without set pixels is noted") {
  const ImagePtr all = run_image("distance", {{"threshold", 0.2}}, {{"mask", speck()}});
  for (const float v : all->pixels()) CHECK(v == 0);
  const NodeRun none = run_node("distance", {{"threshold", 2.0}, {"limit", 5.0}}, {{"mask", {speck()}}});
  for (const float v : none.get<Image>("distance")->pixels()) CHECK(v == 5);
  REQUIRE(none.notes.size() == 1);
  CHECK(none.notes.front().find("no pixel is at or above the threshold") == 0);
}

TEST_CASE("distance takes masks of one channel only, and is the same for all threads and tiles") {
  CHECK(error_of("distance", {}, {{"mask", flat_image({2, 2}, {0, 0})}}, "mask").find("1 channel") !=
        std::string::npos);
  check_every_size([](Size size) {
    return run_image("distance", {{"signed", true}}, {{"mask", noise_image(size, 1)}});
  });
}
