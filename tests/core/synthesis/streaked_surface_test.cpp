#include "core/synthesis/streaked_surface.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

#include <doctest/doctest.h>

#include "core/analysis/repeats/streaks.h"
#include "tests/exemplars.h"

using namespace terrazzo;
using namespace terrazzo::test;

namespace {

constexpr Size exemplar = {196, 160};
constexpr int step = 4;

IndexPtr index_of_streaks(bool along_x = true, bool wraps = false) {
  const Size size = along_x ? exemplar : Size{exemplar.height, exemplar.width};
  const FeaturesPtr metal = plain_features(brushed(size, along_x), wraps);
  const FeaturesPtr features = metal->with(with_streaks(*metal, Task()));
  REQUIRE(features->repeats().streaks == (along_x ? Streaks{step, 1} : Streaks{1, step}));
  return make_index(make_appearance(*features, {}, {}, Task()), 3, Task());
}

/// Of the pixels to the right of others, those that do not show what follows in the exemplar.
std::vector<int> streak_ends(const UvMap& uv) {
  std::vector<int> ends;
  for (int y = 0; y < uv.size().height; y++)
    for (int x = 1; x < uv.size().width; x++) {
      const ExemplarPixel before = uv.at(x - 1, y), here = uv.at(x, y);
      if (here.x != before.x + 1 || here.y != before.y) ends.push_back(x);
    }
  return ends;
}

void check_part(const Index& index, const SynthesisOptions& options, const UvMap& all, const Rect& region) {
  CAPTURE(region.x);
  CAPTURE(region.y);
  const UvMapPtr part = refine(index, *coarse_uv(index, options, Task()), options, region, Task());
  int different = 0;
  for (int y = 0; y < region.height; y++)
    for (int x = 0; x < region.width; x++)
      different += part->at(x, y) != all.at((region.x + x) % all.size().width, (region.y + y) % all.size().height);
  CHECK(different == 0);
}

}  // namespace

TEST_CASE("an index of streaks is as much shorter, and the result shows the exemplar's pixels one after the other") {
  const IndexPtr index = index_of_streaks();
  CHECK(index->appearance()->size() == exemplar);
  CHECK(index->appearance()->levels().front().size == Size{exemplar.width / step, exemplar.height});
  const UvMapPtr uv = synthesize(*index, {.size = {301, 120}}, Task());
  REQUIRE(uv->size() == Size{301, 120});
  CHECK(uv->exemplar() == exemplar);
  const std::vector<int> ends = streak_ends(*uv);
  CHECK(!ends.empty());
  CHECK(double(ends.size()) < 301.0 * 120 / (2 * step));
  std::set<int> places;
  for (const int x : ends) places.insert(x % step);
  INFO("If all streaks ended at whole steps, columns of ends would show.");
  CHECK(places.size() == step);
}

TEST_CASE("streaks along y are those along x, turned") {
  const IndexPtr index = index_of_streaks(false);
  const UvMapPtr uv = synthesize(*index, {.size = {90, 203}, .seed = 4}, Task());
  int goes_on = 0;
  for (int y = 1; y < 203; y++)
    for (int x = 0; x < 90; x++)
      goes_on += uv->at(x, y).y == uv->at(x, y - 1).y + 1 && uv->at(x, y).x == uv->at(x, y - 1).x;
  CHECK(goes_on > 90 * 203 * 3 / 4);
}

TEST_CASE("coarse levels of streaks are seen drawn out, in the proportions of the whole") {
  for (const bool along_x : {true, false}) {
    CAPTURE(along_x);
    const IndexPtr index = index_of_streaks(along_x);
    const Size size = along_x ? Size{304, 120} : Size{120, 304}, from = index->appearance()->size();
    std::vector<UvMapPtr> shown;
    const UvMapPtr whole =
        synthesize(*index, {.size = size}, Task(nullptr, {}, [&](const UvMapPtr& coarse) { shown.push_back(coarse); }));
    CHECK(whole->pixels() == synthesize(*index, {.size = size}, Task())->pixels());
    REQUIRE(!shown.empty());
    for (const UvMapPtr& uv : shown) {
      CHECK(uv->exemplar() == from);
      const int level = int(std::lround(std::log2(double(size.area()) / double(uv->size().area())) / 2));
      CAPTURE(level);
      CHECK(uv->size() == Size{size.width >> level, size.height >> level});
      // Along a step, a pixel shows what lies a block of the exemplar farther on.
      int64_t follows = 0, all = 0;
      for (int y = along_x ? 0 : 1; y < uv->size().height; y++)
        for (int x = along_x ? 1 : 0; x < uv->size().width; x++) {
          if ((along_x ? x : y) % step == 0) continue;
          const ExemplarPixel here = uv->at(x, y), before = uv->at(x - along_x, y - !along_x);
          const int by = along_x ? here.x - before.x : here.y - before.y,
                    aside = along_x ? here.y - before.y : here.x - before.x;
          const bool is_cut = along_x ? here.x == from.width - 1 : here.y == from.height - 1;
          follows += (by == 1 << level || is_cut) && aside == 0;
          all++;
        }
      CHECK(follows == all);
    }
  }
}

TEST_CASE("parts of a surface of streaks are parts of the whole, bit for bit") {
  for (const bool along_x : {true, false})
    for (const bool tiles : {false, true}) {
      CAPTURE(along_x);
      CAPTURE(tiles);
      const IndexPtr index = index_of_streaks(along_x, tiles);
      const Size size = along_x ? Size{1403, 40} : Size{40, 1403};
      const SynthesisOptions options{.size = size, .seed = 3, .tile_x = tiles, .tile_y = tiles};
      const UvMapPtr all = synthesize(*index, options, Task());
      check_part(*index, options, *all, whole(size));
      check_part(*index, options, *all, {0, 0, 9, 7});
      check_part(*index, options, *all, along_x ? Rect{701, 3, 50, 20} : Rect{3, 701, 20, 50});
      check_part(*index, options, *all, {size.width - 5, size.height - 6, 5, 6});
      if (tiles) check_part(*index, options, *all, {size.width - 5, size.height - 6, 12, 15});
    }
}

TEST_CASE("kept pixels of streaks stay as they are, also within a step") {
  const IndexPtr index = index_of_streaks();
  SynthesisOptions options{.size = {120, 60}};
  options.kept.pixels.resize(size_t(options.size.area()));
  options.kept.keep.assign(size_t(options.size.area()), Keep::never);
  for (int y = 10; y < 40; y++)
    for (int x = 31; x < 77; x++) {
      const size_t at = size_t(y) * 120 + x;
      options.kept.pixels[at] = {uint16_t(x + 60), uint16_t(y + 50)};
      options.kept.keep[at] = x % 3 == 0 ? Keep::at_first : Keep::always;
    }
  const UvMapPtr uv = synthesize(*index, options, Task());
  int changed = 0;
  for (size_t i = 0; i < options.kept.keep.size(); i++)
    changed += options.kept.keep[i] == Keep::always && uv->pixels()[i] != options.kept.pixels[i];
  CHECK(changed == 0);
  std::set<int> places;  // of the last new pixel to the left of what is kept
  for (int y = 10; y < 40; y++) {
    int x = 30;
    while (x > 0 && uv->at(x, y).x + 31 - x == uv->at(31, y).x && uv->at(x, y).y == uv->at(31, y).y) x--;
    places.insert(x);
  }
  INFO("What is kept goes on to the left as well, by as much as the lot says.");
  CHECK(places.size() > 1);
}

TEST_CASE("controls place streaks in step with the result") {
  const IndexPtr index = index_of_streaks();
  const auto halves = [](Size size) {
    return make_image(size, 1, [=](int, int y, int) { return y < size.height / 2 ? 0.0f : 1.0f; });
  };
  const SynthesisOptions options{
      .size = {200, 120}, .controls = {{.exemplar = halves(exemplar), .target = halves({200, 120}), .strength = 10}}};
  const UvMapPtr uv = synthesize(*index, options, Task());
  int wrong = 0;
  for (int y = 0; y < 120; y++)
    for (int x = 0; x < 200; x++) wrong += (uv->at(x, y).y < exemplar.height / 2) != (y < 60);
  CHECK(wrong < 200 * 120 / 50);
}
