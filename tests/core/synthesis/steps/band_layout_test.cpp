#include "core/synthesis/steps/band_layout.h"

#include <algorithm>
#include <set>
#include <utility>
#include <vector>

#include <doctest/doctest.h>

#include "core/metrics/whole_elements.h"
#include "core/synthesis/synthesize.h"
#include "tests/drawn_panels.h"

using namespace terrazzo;
using test::DrawnPanels;

namespace {

const Task task;

double whole_share(const UvMap& uv, const Appearance& appearance) {
  const ShownElements shown = shown_elements(uv, *appearance.elements(), task);
  REQUIRE(shown.all > 10);
  return double(shown.whole) / shown.all;
}

/// The courses that a line across a result shows, one after the other.
std::vector<int> courses_of(const UvMap& uv, bool turned) {
  std::vector<int> out;
  for (int v = 0; v < (turned ? uv.size().width : uv.size().height); v++) {
    const ExemplarPixel p = turned ? uv.at(v, 5) : uv.at(5, v);
    const int course = DrawnPanels::course_at(turned ? p.x : p.y);
    if (out.empty() || out.back() != course) out.push_back(course);
  }
  return out;
}

}  // namespace

TEST_CASE("an exemplar of courses that come once is not repeated as it is, and its panels are whole") {
  for (const bool turned : {false, true}) {
    const AppearancePtr appearance = DrawnPanels(turned).appearance();
    const IndexPtr index = make_index(appearance, 3, task);
    const auto made = [&](bool whole_bricks, Quality quality) {
      return synthesize(*index, {.size = {800, 800}, .seed = 4, .quality = quality, .whole_bricks = whole_bricks},
                        task);
    };
    /// The share of pixels that show what the exemplar's length further along is shown.
    const auto again = [&](const UvMap& uv) {
      int same = 0;
      for (int v = 0; v < 800; v++)
        for (int u = 0; u < 600; u++)
          same += turned ? uv.at(v, u) == uv.at(v, u + 200) : uv.at(u, v) == uv.at(u + 200, v);
      return same / (800.0 * 600);
    };
    CHECK(again(*made(false, Quality::normal)) > 0.9);
    const UvMapPtr laid = made(true, Quality::normal);
    CHECK(again(*laid) < 0.5);
    CHECK(whole_share(*laid, *appearance) > 0.95);
    const std::vector<int> courses = courses_of(*laid, turned);
    std::set<std::pair<int, int>> after;
    for (size_t i = 1; i < courses.size(); i++) after.emplace(courses[i - 1], courses[i]);
    CHECK(after.size() > 3);  // in the exemplar there are three
    // In drafts it comes as it is.
    CHECK(again(*made(true, Quality::draft)) > 0.9);
  }
}

TEST_CASE("a result that wraps shows whole panels whatever its size") {
  const AppearancePtr appearance = DrawnPanels(false).appearance();
  const IndexPtr index = make_index(appearance, 3, task);
  for (const Size s : {Size{531, 567}, Size{640, 711}}) {
    const UvMapPtr uv = synthesize(*index, {.size = s, .seed = 2, .tile_x = true, .tile_y = true}, task);
    CHECK(whole_share(*uv, *appearance) > 0.9);
  }
}

TEST_CASE("bands cover all blocks of a result, also of one that wraps after an odd number of pixels") {
  const ElementCourses courses = element_courses(*DrawnPanels(false).appearance()->elements(), true);
  REQUIRE(courses.bands.size() == 3);
  for (const int height : {566, 567})
    for (const uint64_t bits : {1, 2, 3, 4}) {
      const auto bands = bands_of(courses, DrawnPanels::size, {{300, height}, true, true}, {}, bits);
      CHECK(bands.back().end - bands.front().begin == doctest::Approx(height + height % 2));
      for (size_t i = 1; i < bands.size(); i++) CHECK(bands[i].begin == doctest::Approx(bands[i - 1].end));
    }
}

TEST_CASE("around kept pixels courses and panels go on") {
  const AppearancePtr appearance = DrawnPanels(false).appearance();
  const IndexPtr index = make_index(appearance, 3, task);
  const Size small{420, 430}, large{800, 790};
  const int left = 170, top = 150;
  const UvMapPtr first = synthesize(*index, {.size = small, .seed = 2}, task);
  SynthesisOptions options{.size = large, .seed = 9};
  options.kept = {std::vector<ExemplarPixel>(size_t(large.area())),
                  std::vector<Keep>(size_t(large.area()), Keep::never)};
  for (int y = 0; y < small.height; y++)
    for (int x = 0; x < small.width; x++) {
      const size_t at = size_t(y + top) * size_t(large.width) + size_t(x + left);
      options.kept.pixels[at] = first->at(x, y);
      options.kept.keep[at] = Keep::always;
    }
  const UvMapPtr uv = synthesize(*index, options, task);
  for (int y = 0; y < small.height; y++)
    for (int x = 0; x < small.width; x++) REQUIRE(uv->at(x + left, y + top) == first->at(x, y));
  CHECK(whole_share(*uv, *appearance) > 0.95);
}
