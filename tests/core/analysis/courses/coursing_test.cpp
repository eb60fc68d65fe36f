#include "core/analysis/courses/coursing.h"

#include <algorithm>
#include <cmath>

#include <doctest/doctest.h>

#include "tests/drawn_wall.h"

using namespace terrazzo;
using test::DrawnWall;

namespace {

Coursing coursing_of(const ImagePtr& image, const Lattice& lattice) {
  return find_coursing(*make_appearance(*test::plain_features(image)->with(lattice), {}, {}, Task()), Task());
}

/// Where joints across surely are.
std::vector<double> sure_joints(const ExemplarCourse& course) {
  std::vector<double> out;
  for (size_t u = 0; u < course.joint.size(); u++) {
    const size_t begin = u;
    while (u < course.joint.size() && course.joint[u] > 0.75f) u++;
    if (u > begin) out.push_back(double(begin + u) / 2);
  }
  return out;
}

}  // namespace

TEST_CASE("every course of a wall is found, and where its bricks end, lying and standing") {
  for (const bool upright : {false, true}) {
    CAPTURE(upright);
    const DrawnWall wall({240, 220}, upright);
    const Coursing m = find_coursing(*wall.appearance(), Task());
    REQUIRE(!m.empty());
    CHECK(m.axes.upright == upright);
    CHECK(m.axes.rise == 0);
    CHECK(m.separability > 2);
    CHECK(m.level == 0);
    CHECK(m.period == DrawnWall::course);
    REQUIRE(m.beds.size() == 1);
    CHECK(m.beds[0] == doctest::Approx(DrawnWall::joint / 2.0).epsilon(0.5));
    const int breadth = upright ? 240 : 220;
    CHECK(int(m.courses.size()) >= breadth / DrawnWall::course - 1);
    for (const ExemplarCourse& c : m.courses) {
      const int number = int(c.begin + c.end) / 2 / DrawnWall::course;
      CAPTURE(number);
      CHECK(c.end - c.begin == doctest::Approx(DrawnWall::course));
      REQUIRE(int(c.joint.size()) == (upright ? 220 : 240));
      const std::vector<double> found = sure_joints(c);
      const std::vector<int> drawn = wall.joints(number);
      for (const int at : drawn)
        CHECK(std::ranges::any_of(found, [&](double f) { return std::abs(f - at - DrawnWall::joint / 2.0) <= 1.5; }));
      // Besides those perhaps one that a border cuts.
      CHECK(found.size() <= drawn.size() + 2);
    }
  }
}

TEST_CASE("large courses are looked at where pixels are larger") {
  const DrawnWall wall({240, 220});
  const std::vector<float> image = wall.image()->pixels();
  const ImagePtr large = test::make_image(
      {1200, 1100}, 3, [&](int x, int y, int c) { return image[(size_t(y / 5) * 240 + x / 5) * 3 + c]; },
      Semantic::base_color, "srgb_texture");
  const Coursing m = coursing_of(large, {1, {0, 5.0 * DrawnWall::course}, {}, 0.9});
  REQUIRE(!m.empty());
  CHECK(m.level == 1);
  CHECK(m.period == 2.5 * DrawnWall::course);
}

TEST_CASE("courses of two heights that take turns are two kinds") {
  // Joints at 0 and 14 of every 40 rows; joints across in both.
  const ImagePtr image = test::make_image(
      {256, 240}, 3,
      [](int x, int y, int c) {
        const int place = y % 40, course = y / 40 * 2 + (place >= 14), shifted = x + course * 17;
        const double speckle = 0.05 * unit_double(random_bits(6, x, y, c));
        if (place < 3 || (place >= 14 && place < 17) || shifted % 48 < 3) return float(0.8 + speckle);
        return float(0.2 + 0.2 * unit_double(random_bits(5, course, shifted / 48)) + speckle);
      },
      Semantic::base_color, "srgb_texture");
  const Coursing m = coursing_of(image, {1, {0, 40}, {}, 0.9});
  REQUIRE(m.beds.size() == 2);
  CHECK(m.beds[1] - m.beds[0] == doctest::Approx(14).epsilon(0.1));
  for (const ExemplarCourse& c : m.courses)
    CHECK(c.end - c.begin == doctest::Approx(c.kind == 0 ? 14 : 26).epsilon(0.1));
}

TEST_CASE("courses that rise are followed") {
  constexpr double rise = 1.0 / 64;
  const DrawnWall wall({320, 300});
  const std::vector<float> level = wall.image()->pixels();
  const ImagePtr image = test::make_image(
      {320, 280}, 3,
      [&](int x, int y, int c) {
        return level[(size_t(std::max(0, y - int(std::floor(rise * x)))) * 320 + x) * 3 + c];
      },
      Semantic::base_color, "srgb_texture");
  const Coursing m = coursing_of(image, {2, {64, 64 * rise}, {32, DrawnWall::course + 32 * rise}, 0.5});
  REQUIRE(!m.empty());
  CHECK(m.axes.rise == doctest::Approx(rise));
  double found = 0, drawn = 0;
  for (const ExemplarCourse& c : m.courses) {
    found += double(sure_joints(c).size());
    drawn += double(wall.joints(int(c.begin + c.end) / 2 / DrawnWall::course).size());
  }
  CHECK(found == doctest::Approx(drawn).epsilon(0.2));
}

TEST_CASE("what goes on across courses is not cut up") {
  // Stack bond: all bricks of a row of columns end together.
  const ImagePtr image = test::make_image(
      {256, 240}, 3,
      [](int x, int y, int c) {
        const double speckle = 0.05 * unit_double(random_bits(6, x, y, c));
        if (y % 40 < 3 || x % 64 < 3) return float(0.8 + speckle);
        return float(0.2 + 0.2 * unit_double(random_bits(5, y / 40, x / 64)) + speckle);
      },
      Semantic::base_color, "srgb_texture");
  CHECK(coursing_of(image, {1, {0, 40}, {}, 0.9}).empty());
  CHECK(coursing_of(image, {2, {64, 0}, {0, 40}, 0.9}).empty());
}

TEST_CASE("joints across that are shallower than those along are found by how they stand out") {
  constexpr int course = 40, brick = 96, shift = 37;
  const auto wall = [](float across, int shifted_by) {
    return test::make_image(
        {320, 240}, 3,
        [=](int x, int y, int c) {
          const float speckle = 0.05f * float(unit_double(random_bits(6, x, y, c)));
          const int number = y / course, shifted = x + number * shifted_by;
          if (y % course < 3) return 0.8f + speckle;
          if (shifted % brick < 3) return across + speckle;
          return 0.2f + 0.1f * float(unit_double(random_bits(5, number, shifted / brick))) + speckle;
        },
        Semantic::base_color, "srgb_texture");
  };
  const Lattice courses{1, {0, course}, {}, 0.9};
  const Coursing m = coursing_of(wall(0.5f, shift), courses);
  REQUIRE(m.courses.size() == 6);
  for (const ExemplarCourse& c : m.courses) {
    const int number = int(c.begin + c.end) / 2 / course;
    CAPTURE(number);
    const std::vector<double> found = sure_joints(c);
    int drawn = 0;
    for (int x = 4; x < 316; x++) {
      if ((x + number * shift) % brick != 1) continue;
      drawn++;
      CHECK(std::ranges::any_of(found, [&](double f) { return std::abs(f - x - 0.5) <= 1.5; }));
    }
    // Besides those perhaps one that a border cuts.
    CHECK(int(found.size()) <= drawn + 2);
  }
  SUBCASE("but not what goes on across courses") {
    CHECK(coursing_of(wall(0.5f, 0), courses).empty());
  }
  SUBCASE("nor what does not stand out") {
    CHECK(coursing_of(wall(0.25f, shift), courses).empty());
  }
}

TEST_CASE("walls are left alone of which the border cuts a fifth") {
  const auto courses = [](int height) { return find_coursing(*DrawnWall({240, height}).appearance(), Task()).courses; };
  CHECK(courses(84).size() == 3);
  CHECK(courses(91).empty());
}

TEST_CASE("two courses are enough to be laid") {
  CHECK(find_coursing(*DrawnWall({240, 56}).appearance(), Task()).courses.size() == 2);
}

TEST_CASE("bricks that are all alike are left to a lattice that has them") {
  // Running bond: bricks of 64x40, every other course half a brick farther on.
  const auto wall = [](float tints) {
    return test::make_image(
        {320, 240}, 3,
        [tints](int x, int y, int c) {
          const float speckle = 0.05f * float(unit_double(random_bits(6, x, y, c)));
          const int course = y / 40, shifted = x + course % 2 * 32;
          if (y % 40 < 3 || shifted % 64 < 3) return 0.8f + speckle;
          return 0.2f + tints * float(unit_double(random_bits(5, course, shifted / 64))) + speckle;
        },
        Semantic::base_color, "srgb_texture");
  };
  const Lattice bond{2, {64, 0}, {32, 40}, 0.9}, other_bond{2, {90, 0}, {45, 40}, 0.9}, courses{1, {0, 40}, {}, 0.9};
  const ImagePtr alike = wall(0), of_many_tints = wall(0.2f);
  CHECK(coursing_of(alike, bond).empty());
  CHECK(!coursing_of(of_many_tints, bond).empty());
  CHECK(!coursing_of(alike, other_bond).empty());
  CHECK(!coursing_of(alike, courses).empty());
}

TEST_CASE("there are no courses to lay without courses, without joints, or where bricks hardly end") {
  const ImagePtr image = DrawnWall({240, 220}).image();
  CHECK(coursing_of(image, {}).empty());
  CHECK(coursing_of(image, {1, {0, 9}, {}, 0.9}).empty());
  const auto speckles = [](int x, int y, int c) { return float(0.3 + 0.2 * unit_double(random_bits(6, x, y, c))); };
  const Lattice courses{1, {0, DrawnWall::course}, {}, 0.9};
  CHECK(coursing_of(test::make_image({240, 220}, 3, speckles, Semantic::base_color, "srgb_texture"), courses).empty());
  const auto boards = [&](int x, int y, int c) { return y % DrawnWall::course < 4 ? 0.8f : speckles(x, y, c); };
  CHECK(coursing_of(test::make_image({240, 220}, 3, boards, Semantic::base_color, "srgb_texture"), courses).empty());
  CHECK(coursing_of(test::make_image({64, 60}, 3, [](int, int, int) { return 0.5f; }), courses).empty());
}
