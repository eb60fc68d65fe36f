#include "core/synthesis/steps/course_layout.h"

#include <algorithm>
#include <cstdlib>
#include <map>
#include <set>

#include <doctest/doctest.h>
#include <tbb/task_arena.h>

#include "core/synthesis/synthesize.h"
#include "tests/drawn_wall.h"

using namespace terrazzo;
using test::DrawnWall;

namespace {

const Task task;

struct Laid {
  DrawnWall wall;
  UvMapPtr uv;
};

Laid lay(const DrawnWall& wall, const SynthesisOptions& options) {
  return {wall, synthesize(*make_index(wall.appearance(), 3, task), options, task)};
}

/// Of the bricks along the middles of the result's courses, how many are not one brick of the exemplar, from joint to
/// joint. If the result does not wrap, but for those that its border cuts.
double cut_share(const Laid& laid, bool wraps = false) {
  const Size size = laid.uv->size();
  const bool upright = laid.wall.upright();
  const int length = upright ? size.height : size.width, breadth = upright ? size.width : size.height;
  const auto courses = int(breadth / DrawnWall::course + 0.5);
  int cut = 0, all = 0;
  for (int c = 0; c < courses; c++) {
    const int middle = c * breadth / courses + (DrawnWall::course + DrawnWall::joint) / 2;
    const auto at = [&](int along) { return upright ? laid.uv->at(middle, along) : laid.uv->at(along, middle); };
    const auto brick = [&](int along) { return laid.wall.brick(at(along).x, at(along).y); };
    const auto goes_on = [&](int along, int next) {
      const int step = upright ? at(next).y - at(along).y : at(next).x - at(along).x;
      return brick(along) == brick(next) && std::abs(step - 1) <= 2;
    };
    int first = 0;
    while (first < length && brick(first) != DrawnWall::no_brick) first++;
    bool whole = true, any = false;
    for (int x = first; x + 1 < first + length; x++) {
      if (x + 1 >= length && !wraps) break;
      const int here = x % length, next = (x + 1) % length;
      if (brick(next) == DrawnWall::no_brick) {
        all += any;
        cut += any && !whole;
        whole = true;
        any = false;
        continue;
      }
      any = true;
      if (brick(here) != DrawnWall::no_brick) whole &= goes_on(here, next);
    }
  }
  return double(cut) / all;
}

/// Of the places in which a course goes on with another part of the exemplar, the share right above or below another.
double aligned_share(const Laid& laid) {
  const Size size = laid.uv->size();
  std::vector<std::vector<int>> cuts;
  for (int y = (DrawnWall::course + DrawnWall::joint) / 2; y < size.height; y += DrawnWall::course) {
    std::vector<int>& here = cuts.emplace_back();
    for (int x = 0; x + 1 < size.width; x++)
      if (std::abs(laid.uv->at(x + 1, y).x - laid.uv->at(x, y).x - 1) > 8 && (here.empty() || x > here.back() + 8))
        here.push_back(x);
  }
  int aligned = 0, all = 0;
  for (size_t c = 1; c < cuts.size(); c++)
    for (const int x : cuts[c]) {
      all++;
      aligned += std::ranges::any_of(cuts[c - 1], [&](int above) { return std::abs(above - x) <= 8; });
    }
  return double(aligned) / all;
}

}  // namespace

TEST_CASE("courses are not cut one above the other") {
  const DrawnWall wall({240, 220});
  double share = 0;
  for (const uint64_t seed : {1, 2, 3}) share += aligned_share(lay(wall, {.size = {480, 480}, .seed = seed})) / 3;
  CHECK(share < 0.2);
}

TEST_CASE("bricks of a wall are whole in what is made of it, lying and standing") {
  for (const bool upright : {false, true}) {
    CAPTURE(upright);
    const DrawnWall wall({240, 220}, upright);
    CHECK(cut_share(lay(wall, {.size = {480, 480}, .seed = 1})) < 0.15);
    // What the figure is worth: they need not be laid, and in drafts are not.
    CHECK(cut_share(lay(wall, {.size = {480, 480}, .seed = 1, .whole_bricks = false})) > 0.3);
    CHECK(cut_share(lay(wall, {.size = {480, 480}, .seed = 1, .quality = Quality::draft})) > 0.3);
  }
}

TEST_CASE("bricks are whole across the border of results that wrap") {
  const DrawnWall wall({240, 220});
  CHECK(cut_share(lay(wall, {.size = {433, 480}, .seed = 2, .tile_x = true, .tile_y = true}), true) < 0.15);
}

TEST_CASE("laid bricks are the same on any number of threads") {
  const DrawnWall wall({240, 220});
  std::set<Digest> digests;
  for (const int threads : {1, 2, 4})
    tbb::task_arena(threads).execute([&] {
      digests.insert(lay(wall, {.size = {301, 347}, .seed = 3, .tile_y = true}).uv->digest());
    });
  CHECK(digests.size() == 1);
}

TEST_CASE("courses stay in their places, and no brick takes over") {
  const DrawnWall wall({240, 220});
  const Laid laid = lay(wall, {.size = {480, 480}, .seed = 4});
  std::map<int, int> use;
  // The seed says where courses start.
  const auto phase = [&](int x, int y) { return wrap(laid.uv->at(x, y).y - y, DrawnWall::course); };
  const int start = phase(240, 240);
  for (int y = 0; y < 480; y++)
    for (int x = 0; x < 480; x++) {
      const ExemplarPixel p = laid.uv->at(x, y);
      const int off = wrap(phase(x, y) - start, DrawnWall::course);
      CHECK_MESSAGE((off <= 2 || off >= DrawnWall::course - 2), x, " ", y, " shows ", p.x, " ", p.y);
      use[wall.brick(p.x, p.y)]++;
    }
  use.erase(DrawnWall::no_brick);
  int most = 0;
  for (const auto& [brick, count] : use) most = std::max(most, count);
  CHECK(use.size() > 30);
  CHECK(most < 480 * 480 / 10);
}

TEST_CASE("sizes smaller than a brick, and masks, do no harm") {
  const DrawnWall wall({240, 220});
  for (const Size size : {Size{1, 1}, Size{17, 300}, Size{300, 5}, Size{61, 47}})
    for (const bool wraps : {false, true})
      CHECK(lay(wall, {.size = size, .seed = 5, .tile_x = wraps, .tile_y = wraps}).uv->size() == size);

  // Only the right half may be shown.
  const ImagePtr image = wall.image();
  const ImagePtr mask = test::make_image(wall.size(), 1, [](int x, int, int) { return x >= 120 ? 1.0f : 0.0f; });
  const FeaturesPtr features = Features::make(wall.size(), {{image, {1, 1, 1}}}, false, wall.lattice(), mask);
  const IndexPtr index = make_index(make_appearance(*features, {}, {}, task), 3, task);
  const UvMapPtr uv = synthesize(*index, {.size = {300, 200}, .seed = 5}, task);
  for (const ExemplarPixel p : uv->pixels()) REQUIRE(p.x >= 120);
}
