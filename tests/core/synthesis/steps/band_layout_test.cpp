#include "core/synthesis/steps/band_layout.h"

#include <algorithm>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include <doctest/doctest.h>
#include <tbb/task_arena.h>

#include "core/metrics/whole_elements.h"
#include "core/synthesis/synthesize.h"
#include "tests/drawn_panels.h"
#include "tests/drawn_wall.h"

using namespace terrazzo;
using test::DrawnPanels;
using test::DrawnWall;

namespace {

const Task task;

double whole_share(const UvMap& uv, const Appearance& appearance) {
  const ShownElements shown = shown_elements(uv, *appearance.elements(), task);
  REQUIRE(shown.all > 10);
  return double(shown.whole) / shown.all;
}

/// The courses that a line across a result shows, one after the other, but for the joints between them.
std::vector<int> courses_of(const UvMap& uv, bool turned) {
  std::vector<int> out;
  int before = -1, run = 0;
  for (int v = 0; v < (turned ? uv.size().width : uv.size().height); v++) {
    const ExemplarPixel p = turned ? uv.at(v, 5) : uv.at(5, v);
    const int course = DrawnPanels::course_at(turned ? p.x : p.y);
    run = course == before ? run + 1 : 1;
    before = course;
    if (run == 8 && (out.empty() || out.back() != course)) out.push_back(course);
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

TEST_CASE("bricks of a wall are whole in what is made of it, lying and standing") {
  for (const bool upright : {false, true}) {
    CAPTURE(upright);
    const AppearancePtr appearance = DrawnWall({240, 220}, upright).appearance();
    const IndexPtr index = make_index(appearance, 3, task);
    SynthesisOptions options{.size = {480, 480}, .seed = 1};
    CHECK(whole_share(*synthesize(*index, options, task), *appearance) > 0.9);
    // What the figure is worth: they need not be laid, and in drafts are not.
    options.whole_bricks = false;
    CHECK(whole_share(*synthesize(*index, options, task), *appearance) < 0.7);
    options = {.size = {480, 480}, .seed = 1, .quality = Quality::draft};
    CHECK(whole_share(*synthesize(*index, options, task), *appearance) < 0.7);
    options = {.size = {433, 480}, .seed = 2, .tile_x = true, .tile_y = true};
    CHECK(whole_share(*synthesize(*index, options, task), *appearance) > 0.9);
  }
}

TEST_CASE("a course takes bricks from all courses as high as it is, and no brick takes over or lies beside itself") {
  const DrawnWall wall({240, 220});
  const UvMapPtr uv = synthesize(*make_index(wall.appearance(), 3, task), {.size = {480, 480}, .seed = 4}, task);
  std::map<int, int> use;
  int beside = 0;
  double courses = 0;
  for (int y = 0; y < 480; y++) {
    std::set<int> from;
    for (int x = 0; x < 480; x++) {
      const ExemplarPixel p = uv->at(x, y);
      const int brick = wall.brick(p.x, p.y);
      use[brick]++;
      from.insert(brick / 1000);
      if (brick == DrawnWall::no_brick || y + DrawnWall::course >= 480) continue;
      const ExemplarPixel below = uv->at(x, y + DrawnWall::course);
      beside += wall.brick(below.x, below.y) == brick;
    }
    courses += double(from.size()) / 480;
  }
  CHECK(courses > 4);
  CHECK(beside < 480 * 480 / 50);
  use.erase(DrawnWall::no_brick);
  int most = 0;
  for (const auto& [brick, count] : use) most = std::max(most, count);
  CHECK(use.size() > 20);
  CHECK(most < 480 * 480 / 15);
}

TEST_CASE("laid bricks are the same on any number of threads") {
  const IndexPtr index = make_index(DrawnWall({240, 220}).appearance(), 3, task);
  std::set<Digest> digests;
  for (const int threads : {1, 2, 4})
    tbb::task_arena(threads).execute([&] {
      digests.insert(synthesize(*index, {.size = {301, 347}, .seed = 3, .tile_y = true}, task)->digest());
    });
  CHECK(digests.size() == 1);
}

TEST_CASE("sizes smaller than a brick, and masks, do no harm") {
  const DrawnWall wall({240, 220});
  const IndexPtr index = make_index(wall.appearance(), 3, task);
  for (const Size size : {Size{1, 1}, Size{17, 300}, Size{300, 5}, Size{61, 47}})
    for (const bool wraps : {false, true})
      CHECK(synthesize(*index, {.size = size, .seed = 5, .tile_x = wraps, .tile_y = wraps}, task)->size() == size);

  // Only the right half may be shown.
  const ImagePtr mask = test::make_image(wall.size(), 1, [](int x, int, int) { return x >= 120 ? 1.0f : 0.0f; });
  const FeaturesPtr masked = Features::make(wall.size(), {{wall.image(), {1, 1, 1}}}, false, wall.lattice(), mask,
                                            wall.features()->elements());
  const UvMapPtr uv =
      synthesize(*make_index(make_appearance(*masked, {}, {}, task), 3, task), {.size = {300, 200}, .seed = 5}, task);
  for (const ExemplarPixel p : uv->pixels()) REQUIRE(p.x >= 120);
}
