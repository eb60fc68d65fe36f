#include "core/analysis/repeats/through_lines.h"

#include <functional>

#include <doctest/doctest.h>

#include "core/analysis/repeats/regularity.h"
#include "core/base/hash.h"
#include "tests/exemplars.h"

using namespace terrazzo;
using namespace terrazzo::test;

namespace {

double grain(int x, int y) {
  return unit_double(random_bits(4, x, y));
}

/// Three channels, with what `drawn` adds to the second one's grain.
Planes grained(bool wraps, const std::function<double(int, int)>& drawn) {
  Planes out = Planes::zeros({256, 240}, 3, wraps);
  for (int y = 0; y < 240; y++)
    for (int x = 0; x < 256; x++)
      for (int c = 0; c < 3; c++)
        out.at(x, y)[c] = float(unit_double(random_bits(5, x, y, c)) + (c == 1 ? drawn(x, y) : 0));
  return out;
}

FeaturesPtr exemplar(bool wraps, const std::function<double(int, int)>& drawn) {
  return plain_features(
      make_image({160, 128}, 1, [&](int x, int y, int) { return float(0.5 * grain(x, y) + drawn(x, y)); }), wraps);
}

Lattice found(const FeaturesPtr& features) {
  return find_lattice(*features, 0.08, Task()).lattice;
}

}  // namespace

TEST_CASE("a line that goes on from border to border stands out of grain that is as strong") {
  CHECK(strongest_line(grained(true, [](int, int) { return 0; }), true) < 0.5);
  CHECK(strongest_line(grained(true, [](int, int) { return 0; }), false) < 0.5);
  const Planes joint = grained(true, [](int, int y) { return y == 30 ? 0.5 : 0; });
  CHECK(strongest_line(joint, true) > 1);
  CHECK(strongest_line(joint, false) < 0.5);
  const Planes upright = grained(true, [](int x, int) { return x == 30 ? 0.5 : 0; });
  CHECK(strongest_line(upright, true) < 0.5);
  CHECK(strongest_line(upright, false) > 1);
}

TEST_CASE("lines that end, lean or fade are none") {
  CHECK(strongest_line(grained(true, [](int x, int y) { return y == 30 && x < 220 ? 0.5 : 0; }), true) < 0.5);
  CHECK(strongest_line(grained(true, [](int x, int y) { return y == 30 + x / 40 ? 0.5 : 0; }), true) < 0.5);
  CHECK(strongest_line(grained(true, [](int, int y) { return 0.5 * y * (239 - y) / 14400.0; }), true) < 0.5);
  // Light on one half of it, and dark on the other.
  CHECK(strongest_line(grained(true, [](int x, int y) { return y == 30 ? x < 128 ? 0.5 : -0.5 : 0; }), true) < 0.5);
}

TEST_CASE("a line along the border is one only where the exemplar goes on around it") {
  const auto slope = [](int, int y) { return 0.003 * y; };
  CHECK(strongest_line(grained(true, slope), true) > 1);
  CHECK(strongest_line(grained(false, slope), true) < 0.5);
}

TEST_CASE("planes without changes, or narrower than eight pixels, have no lines") {
  CHECK(strongest_line(Planes::zeros({32, 32}, 2, true), true) == 0);
  CHECK(strongest_line(Planes::zeros({7, 32}, 2, true), true) == 0);
  Planes step = Planes::zeros({32, 32}, 1);
  for (int y = 16; y < 32; y++)
    for (int x = 0; x < 32; x++) *step.at(x, y) = 1;
  CHECK(strongest_line(step, true) > 1);
  CHECK(strongest_line(step, false) == 0);
}

TEST_CASE("grain with a joint is one course, or one column, and one cell where joints cross") {
  CHECK(found(exemplar(true, [](int, int) { return 0; })).rank == 0);
  const Lattice course = found(exemplar(true, [](int, int y) { return y < 2 ? 0.5 : 0; }));
  CHECK(course.rank == 1);
  CHECK(course.first == Vector2d(0, 128));
  const Lattice column = found(exemplar(true, [](int x, int) { return x < 2 ? 0.5 : 0; }));
  CHECK(column.rank == 1);
  CHECK(column.first == Vector2d(160, 0));
  CHECK(found(exemplar(true, [](int x, int y) { return x < 2 || y < 2 ? 0.5 : 0; })).is_single_cell({160, 128}));
}

TEST_CASE("of an exemplar that does not tile a joint makes a course, and joints that cross make nothing") {
  CHECK(found(exemplar(false, [](int, int y) { return y == 60 ? 0.5 : 0; })).first == Vector2d(0, 128));
  CHECK(found(exemplar(false, [](int x, int y) { return x == 70 || y == 60 ? 0.5 : 0; })).rank == 0);
}

TEST_CASE("courses with a line across them are cells") {
  const auto boards = [](bool post) {
    return exemplar(true, [post](int x, int y) { return (y % 32 < 2 ? 0.6 : 0) + (post && x < 3 ? 0.6 : 0); });
  };
  CHECK(found(boards(false)).rank == 1);
  const Lattice cells = found(boards(true));
  CHECK(cells.rank == 2);
  CHECK(cells.cell_area() == doctest::Approx(160 * 32).epsilon(0.01));
}
