#include "core/metrics/structure.h"

#include <atomic>
#include <functional>

#include <doctest/doctest.h>

#include "core/base/hash.h"
#include "core/metrics/autocorrelation.h"
#include "tests/core/metrics/textures.h"

using namespace terrazzo;
using namespace terrazzo::test;

namespace {

const Task task;
constexpr int course = 24, joint = 3, shortest = 36, longest = 60;

/// Light joints in dark stone, of one channel with a little grain.
Planes drawn(Size size, const std::function<bool(int, int)>& is_joint) {
  Planes out = Planes::zeros(size, 1);
  for (int y = 0; y < size.height; y++)
    for (int x = 0; x < size.width; x++)
      out.at(x, y)[0] = (is_joint(x, y) ? 3.0f : 0.0f) + 0.3f * float(unit_double(random_bits(1, x, y)));
  return out;
}

/// Courses of stones of several lengths. `stubs`: every third joint between stones ends in the middle of the course.
Planes wall(Size size, uint64_t seed, bool stubs = false) {
  return drawn(size, [=](int x, int y) {
    const int c = y / course, down = y % course;
    if (down < joint) return true;
    int at = -int(below(uint32_t(random_bits(seed, c)), longest));
    for (int i = 0; at <= x; i++) {
      if (x - at < joint && !(stubs && (i + c) % 3 == 0 && down > course / 2)) return true;
      at += shortest + int(below(uint32_t(random_bits(seed, c, i + 1)), longest - shortest));
    }
    return false;
  });
}

/// Boards in columns of 40 pixels. `diamonds`: every second pair of columns is half a board lower.
Planes chevron(Size size, bool diamonds = false) {
  return drawn(size, [=](int x, int y) {
    const int column = x / 40, along = column % 2 ? 39 - x % 40 : x % 40;
    const int lower = diamonds && (column / 2) % 2 ? 16 : 0;
    return x % 40 < joint || (y + along + lower) % 32 < joint;
  });
}

/// The part of an image from a place on.
Planes cropped(const Planes& image, const Rect& part) {
  Planes out = Planes::zeros({part.width, part.height}, image.channels);
  for (int y = 0; y < part.height; y++)
    for (int x = 0; x < part.width; x++) std::copy_n(image.at(part.x + x, part.y + y), image.channels, out.at(x, y));
  return out;
}

double measured(Planes exemplar, const Planes& output, bool wraps = false) {
  exemplar.wraps = wraps;
  return foreign_structure(exemplar, output, 2, task);
}

}  // namespace

TEST_CASE("windows are a third to a half of an element, within an exemplar's quarter") {
  for (const double element : {30.0, 50.0, 64.0, 84.0, 100.0, 150.0, 237.0, 500.0}) {
    const int side = structure_window(element, {4096, 4096}).side();
    CHECK_MESSAGE(side <= element / 2, element);
    if (element > 42) CHECK_MESSAGE(side >= element / 3, element);
  }
  CHECK(structure_window(3, {4096, 4096}).side() == 7);
  CHECK(structure_window(500, {4096, 300}).side() == 56);
  CHECK(structure_window(500, {16, 16}).side() == 7);
  CHECK(structure_window(100, {4096, 4096}).level == 1);
}

TEST_CASE("a wall, its parts and its tilings have the wall's structure") {
  const Planes exemplar = wall({288, 288}, 1);
  CHECK(measured(exemplar, exemplar) == 0);
  CHECK(measured(exemplar, cropped(exemplar, {31, 17, 150, 201})) < 0.01);
  const Planes repeated = chevron({240, 224});
  CHECK(measured(repeated, tiled(repeated, {400, 400}), true) < 0.005);
}

TEST_CASE("what lies around the border of an exemplar that tiles is known") {
  const Planes exemplar = chevron({240, 224});
  Planes shifted = Planes::zeros(exemplar.size, 1);
  for (int y = 0; y < 224; y++)
    for (int x = 0; x < 240; x++) shifted.at(x, y)[0] = exemplar.at((x + 120) % 240, (y + 110) % 224)[0];
  const Planes upper = cropped(shifted, {60, 0, 120, 224});
  const Planes narrow = cropped(exemplar, {0, 0, 60, 224});
  CHECK(measured(exemplar, upper, true) < 0.01);
  // A column and a half: the points at the border are seen only around it.
  CHECK(measured(narrow, tiled(narrow, {240, 224}), true) < 0.01);
  CHECK(measured(narrow, tiled(narrow, {240, 224}), false) > 0.1);
}

TEST_CASE("another sample is about as far as the exemplar's windows are from one another") {
  const double sample = measured(wall({288, 288}, 1), wall({400, 400}, 2));
  CHECK(sample > 0);
  CHECK(sample < 0.1);
}

TEST_CASE("joints that end in the middle of a stone are seen") {
  const Planes exemplar = wall({288, 288}, 1);
  CHECK(measured(exemplar, wall({400, 400}, 2, true)) > 2 * measured(exemplar, wall({400, 400}, 2)));
}

TEST_CASE("diamonds in place of a chevron's points are seen") {
  const Planes exemplar = chevron({240, 224});
  CHECK(measured(exemplar, chevron({480, 480})) < 0.06);
  CHECK(measured(exemplar, chevron({480, 480}, true)) > 0.1);
}

TEST_CASE("courses that jog are seen, and random blocks even more") {
  const Planes exemplar = wall({288, 288}, 1);
  Planes jogs = wall({400, 400}, 2);
  const Planes straight = jogs;
  for (int y = 0; y < 400; y++)
    for (int x = 0; x < 400; x++) jogs.at(x, y)[0] = straight.at(x, (y + (x / 100 % 2) * 8) % 400)[0];
  const double jogged = measured(exemplar, jogs),
               blocks = measured(exemplar, random_blocks(exemplar, {400, 400}, 40, 3));
  CHECK(jogged > 2 * measured(exemplar, straight));
  CHECK(blocks > jogged);
}

TEST_CASE("flat images have no structure") {
  const Planes exemplar = wall({288, 288}, 1), flat = Planes::zeros({288, 288}, 1);
  CHECK(measured(flat, flat) == 0);
  CHECK(measured(exemplar, flat) > 0.9);
  CHECK(measured(flat, exemplar) > 0.9);
}

TEST_CASE("the correlation length grows with the scale of a texture") {
  const Planes fine = spots({96, 96}, 1), coarse = resampled(spots({48, 48}, 1), {96, 96});
  CHECK(correlation_length(fine, task) >= 1);
  CHECK(correlation_length(fine, task) < correlation_length(coarse, task));
  CHECK(correlation_length(Planes::zeros({16, 16}, 1), task) >= 1);
}

TEST_CASE("comparing structure stops when it is cancelled") {
  const std::atomic<bool> cancelled{true};
  CHECK_THROWS_AS(foreign_structure(wall({64, 64}, 1), wall({64, 64}, 2), 1, Task(&cancelled, nullptr)), Cancelled);
}
