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

namespace {

/// Panels of two courses, 60 and 100 pixels high, four and three of them, as a single cell that tiles.
int panel(int x, int y) {
  const int course = y % 160 >= 60;
  const std::vector<int> ends = course ? std::vector<int>{30, 110, 170} : std::vector<int>{0, 50, 90, 140};
  const auto after = std::ranges::upper_bound(ends, x % 200);
  return course * 10 + int(after - ends.begin() + int(ends.size()) - 1) % int(ends.size());
}

AppearancePtr single_cell() {
  const Size size{200, 160};
  const ImagePtr image = test::make_image(
      size, 3,
      [&](int x, int y, int c) {
        const bool joint = panel(x, y) != panel(x + 3, y) || panel(x, y) != panel(x, y + 3);
        const double speckle = 0.05 * unit_double(random_bits(6, x, y, c));
        return float(joint ? 0.05 + speckle : 0.3 + 0.4 * unit_double(random_bits(5, panel(x, y), c)) + speckle);
      },
      Semantic::base_color, "srgb_texture");
  Elements elements{size, {}, 7, 1};
  for (int y = 0; y < size.height; y++)
    for (int x = 0; x < size.width; x++) {
      const int p = panel(x + 2, y + 2);
      elements.at.push_back(uint16_t(p >= 10 ? p - 6 : p));
    }
  const FeaturesPtr features = weighted_features(*Material::of(image), {}, true);
  const Lattice cell{2, {200, 0}, {0, 160}, 0.5};
  return make_appearance(*features->with(cell)->with(std::make_shared<const Elements>(elements)), {}, {}, Task());
}

}  // namespace

TEST_CASE("an exemplar of courses that come once is not repeated as it is, and its panels are whole") {
  const AppearancePtr appearance = single_cell();
  const IndexPtr index = make_index(appearance, 3, task);
  const auto made = [&](bool whole_bricks, Quality quality) {
    return synthesize(*index, {.size = {800, 640}, .seed = 4, .quality = quality, .whole_bricks = whole_bricks}, task);
  };
  /// The share of pixels that show what the exemplar's width further along is shown.
  const auto again = [&](const UvMap& uv) {
    int same = 0;
    for (int y = 0; y < 640; y++)
      for (int x = 0; x < 600; x++) same += uv.at(x, y) == uv.at(x + 200, y);
    return same / (640.0 * 600);
  };
  CHECK(again(*made(false, Quality::normal)) > 0.9);
  const UvMapPtr laid = made(true, Quality::normal);
  CHECK(again(*laid) < 0.6);
  // Each row within a course shows panels from end to end.
  int whole = 0, all = 0;
  for (const int y : {30, 110, 190, 270, 350, 430}) {
    const auto number = [&](int x) { return panel(laid->at(x, y).x, laid->at(x, y).y); };
    int begin = 0;
    while (begin < 800 && number(begin) == number(0)) begin++;
    for (int end = begin + 1; end < 800; end++) {
      const int step = laid->at(end, y).x - laid->at(end - 1, y).x;
      if (step == 1 || step == -199) continue;
      // It goes on elsewhere: both sides are at a joint.
      const auto at_joint = [&](int x) {
        const ExemplarPixel p = laid->at(x, y);
        for (int d = -8; d <= 8; d++)
          if (panel(p.x + 200 + d, p.y) != panel(p.x + 200, p.y)) return true;
        return false;
      };
      all++;
      whole += at_joint(end - 1) && at_joint(end);
    }
  }
  REQUIRE(all > 10);
  CHECK(whole >= 0.95 * all);
  // In drafts it comes as it is.
  CHECK(again(*made(true, Quality::draft)) > 0.9);
}
