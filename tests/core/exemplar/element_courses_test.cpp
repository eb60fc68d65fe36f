#include "core/exemplar/element_courses.h"

#include <algorithm>
#include <functional>
#include <map>

#include <doctest/doctest.h>

using namespace terrazzo;

namespace {

constexpr Size size{240, 180};

/// `name`: of the element at (x, y), any number.
Elements elements(const std::function<int(int, int)>& name, bool turned = false) {
  Elements out{turned ? Size{size.height, size.width} : size, {}, 0, 1};
  std::map<int, uint16_t> numbers;
  for (int y = 0; y < out.size.height; y++)
    for (int x = 0; x < out.size.width; x++) {
      const int of = turned ? name(y, x) : name(x, y);
      out.at.push_back(numbers.emplace(of, uint16_t(numbers.size())).first->second);
    }
  out.count = int(numbers.size());
  return out;
}

/// Three courses, 50, 90 and 40 pixels high, the last of which goes on around the border.
int course_of(int y) {
  return y < 20 || y >= 160 ? 2 : y < 70 ? 0 : 1;
}
int panels(int x, int y) {
  const int course = course_of(y), width = course == 0 ? 60 : course == 1 ? 80 : 48, from = course * 13 + 7;
  return course * 100 + (x + size.width - from) % size.width / width;
}

}  // namespace

TEST_CASE("courses of different heights are found by the joints along them and across, lying and standing") {
  for (const bool turned : {false, true}) {
    const ElementCourses found = element_courses(elements(panels, turned), true);
    REQUIRE(found.bands.size() == 3);
    CHECK(found.upright == turned);
    CHECK(found.lattice(turned ? Size{180, 240} : size).first == (turned ? Vector2d{180, 0} : Vector2d{0, 180}));
    for (size_t k = 0; k < 3; k++) {
      const ExemplarSpan band = found.bands[k];
      CHECK(std::abs(band.from - std::array{20, 70, 160}[k]) <= 1);
      CHECK(std::abs(band.to - std::array{70, 160, 200}[k]) <= 1);  // the last goes on around the border
      const int course = course_of(int(band.from) + 5), width = std::array{60, 80, 48}[size_t(course)];
      REQUIRE(int(found.pieces[k].size()) == size.width / width);
      for (size_t i = 0; i < found.pieces[k].size(); i++) {
        CHECK(std::abs(found.pieces[k][i].from - (course * 13 + 7 + int(i) * width)) <= 1);
        CHECK(std::abs(found.pieces[k][i].length() - width) <= 1);
      }
    }
  }
}

TEST_CASE("what lies side by side in two courses, or goes on over both, is not parted") {
  CHECK(!element_courses(elements(panels), true).empty());
  // A grid has joints along it both ways.
  CHECK(element_courses(elements([](int x, int y) { return y / 60 * 10 + x / 60; }), true).empty());
  // Joints go on from course to course but for one that a panel closes.
  CHECK(element_courses(
            elements([](int x, int y) { return y / 60 * 10 + (y >= 60 && y < 120 && x / 60 == 1 ? 0 : x / 60); }), true)
            .empty());
  // A panel reaches over two of the three courses: the joint between those does not go all along.
  const ElementCourses two = element_courses(
      elements([](int x, int y) { return x >= 110 && x < 150 && y >= 20 && y < 160 ? 99 : panels(x, y); }), true);
  CHECK(two.bands.size() == 2);
  // One that reaches into the next course a little is in none of the pieces, the others are.
  const auto narrow = [&](int x, int y) { return x >= 127 && x < 136 && y >= 20 && y < 110 ? 99 : panels(x, y); };
  const ElementCourses some = element_courses(elements(narrow), true);
  REQUIRE(some.bands.size() == 3);
  for (size_t k = 0; k < 2; k++)
    for (const ExemplarSpan& piece : some.pieces[k]) CHECK((piece.to <= 128 || piece.from >= 135));
  // A rail without joints, or with one.
  const auto with_rail = [&](int joint) {
    return elements([joint](int x, int y) { return y < 20 || y >= 160 ? 200 + (x < joint) : panels(x, y); });
  };
  CHECK(element_courses(with_rail(0), true).empty());
  CHECK(element_courses(with_rail(120), true).bands.size() == 3);
  // Columns without joints across.
  CHECK(element_courses(elements([](int x, int) { return (x + 20) / 60; }), true).empty());
  CHECK(element_courses(Elements{size, std::vector<uint16_t>(size_t(size.area())), 1, 1}, true).empty());
}

TEST_CASE("of an exemplar that does not tile only what its border does not cut counts") {
  // Four courses, the first and the last of which the border cuts, as it does the panels at their ends.
  const auto wall = [](int x, int y) {
    const int course = y < 25 ? 0 : y < 75 ? 1 : y < 145 ? 2 : 3;
    return course * 100 + (x + 17 * course) / 50;
  };
  for (const bool turned : {false, true}) {
    const ElementCourses found = element_courses(elements(wall, turned), false);
    REQUIRE(found.bands.size() == 2);
    CHECK(found.upright == turned);
    CHECK(std::abs(found.bands[0].from - 25) <= 1);
    CHECK(std::abs(found.bands[1].to - 145) <= 1);
    for (const auto& pieces : found.pieces)
      for (const ExemplarSpan& p : pieces) {
        CHECK(p.from > 0);
        CHECK(p.to < size.width);
        CHECK(std::abs(p.length() - 50) <= 1);
      }
  }
}

TEST_CASE("what the far border cuts counts up to there where little else is whole") {
  // One course of three is whole, and of two panels in each of them one or none.
  const auto wall = [](int x, int y) {
    const int course = y < 30 ? 0 : y < 90 ? 1 : 2;
    return course * 100 + (x < 50 + 30 * course ? 0 : x < (course == 1 ? 400 : 180) ? 1 : 2);
  };
  for (const bool turned : {false, true}) {
    const ElementCourses found = element_courses(elements(wall, turned), false);
    REQUIRE(found.bands.size() == 2);
    CHECK(std::abs(found.bands[0].from - 30) <= 1);
    CHECK(found.bands[1].to == 180);
    REQUIRE(found.pieces[0].size() == 1);
    CHECK(std::abs(found.pieces[0][0].from - 80) <= 1);
    CHECK(found.pieces[0][0].to == 240);
    // The last 60 pixels are half as long as the first 110, and the whole panel has 70.
    REQUIRE(found.pieces[1].size() == 2);
    CHECK(found.pieces[1][1].to == 240);
  }
}
