#include "core/synthesis/steps/element_layout.h"

#include <algorithm>
#include <map>

#include <doctest/doctest.h>
#include <tbb/task_arena.h>

#include "core/metrics/hybrids.h"
#include "core/synthesis/synthesize.h"
#include "tests/drawn_stones.h"
#include "tests/drawn_tiles.h"

using namespace terrazzo;
using namespace terrazzo::test;

namespace {

const Task task;
constexpr Size exemplar{240, 240};

/// `known`: the analysis knows the elements.
IndexPtr index_of(const DrawnStones& stones, bool known, bool wraps = true, double certainty = 1) {
  FeaturesPtr features = plain_features(stones.image(), wraps);
  Elements elements = stones.elements();
  elements.certainty = certainty;
  if (known) features = features->with(std::make_shared<const Elements>(elements));
  return make_index(make_appearance(*features, {}, {}, task), 3, task);
}

/// Of the pixels, how many go on to the right as the exemplar does.
double continued(const UvMap& uv) {
  const Size size = uv.exemplar();
  int count = 0;
  for (int y = 0; y < uv.size().height; y++)
    for (int x = 1; x < uv.size().width; x++) {
      const ExemplarPixel p = uv.at(x - 1, y), q = uv.at(x, y);
      count += (p.x + 1) % size.width == q.x && p.y == q.y;
    }
  return double(count) / double(uv.size().area());
}

UvMapPtr made(const Index& index, const SynthesisOptions& options) {
  return synthesize(index, options, task);
}

double hybrids(const DrawnStones& stones, const UvMap& uv) {
  return hybrid_elements(uv, stones.elements(), task).by_area;
}

}  // namespace

TEST_CASE("stones are laid as wholes where the analysis knows them") {
  const DrawnStones stones(exemplar);
  const IndexPtr plain = index_of(stones, false), known = index_of(stones, true);
  for (const uint64_t seed : {1, 2}) {
    const SynthesisOptions options{.size = {420, 400}, .seed = seed};
    const UvMapPtr without = made(*plain, options), with = made(*known, options);
    CHECK(hybrids(stones, *without) > 0.2);
    CHECK(hybrids(stones, *with) < 0.05);
  }
}

TEST_CASE("stones whose outlines are not sure are laid as they are, and seams find their joints") {
  const DrawnStones stones(exemplar);
  const SynthesisOptions options{.size = {420, 400}, .seed = 1};
  const UvMapPtr plain = made(*index_of(stones, false), options), bent = made(*index_of(stones, true), options);
  const IndexPtr unsure = index_of(stones, true, true, 0.3);
  REQUIRE(are_heaped(*unsure->appearance()));
  const UvMapPtr heaped = made(*unsure, options);
  CHECK(hybrids(stones, *heaped) < 0.7 * hybrids(stones, *plain));
  CHECK(continued(*heaped) > continued(*bent) + 0.01);
}

TEST_CASE("an exemplar that does not tile offers its whole stones only") {
  const DrawnStones stones(exemplar, 7);
  const IndexPtr index = index_of(stones, true, false);
  const UvMapPtr uv = made(*index, {.size = {400, 400}, .seed = 3});
  CHECK(hybrids(stones, *uv) < 0.08);
}

TEST_CASE("a result that wraps has whole stones across its borders") {
  const DrawnStones stones(exemplar);
  const UvMapPtr uv = made(*index_of(stones, true), {.size = {360, 360}, .seed = 2, .tile_x = true, .tile_y = true});
  CHECK(uv->wraps().x);
  CHECK(hybrids(stones, *uv) < 0.05);
}

TEST_CASE("around a result that is kept to the pixel, its stones go on and others join them whole") {
  const DrawnStones stones(exemplar);
  const IndexPtr index = index_of(stones, true);
  const UvMapPtr small = made(*index, {.size = {200, 190}, .seed = 4});
  SynthesisOptions options{.size = {420, 400}, .seed = 5, .origin = {96, 104}};
  options.kept.keep.resize(size_t(options.size.area()), Keep::never);
  options.kept.pixels.resize(options.kept.keep.size());
  for (int y = 0; y < small->size().height; y++)
    for (int x = 0; x < small->size().width; x++) {
      const size_t to = size_t(y + options.origin[1]) * size_t(options.size.width) + size_t(x + options.origin[0]);
      options.kept.keep[to] = Keep::always;
      options.kept.pixels[to] = small->at(x, y);
    }
  const UvMapPtr larger = made(*index, options);
  CHECK(hybrids(stones, *larger) < 0.05);
  for (int y = 0; y < small->size().height; y++)
    for (int x = 0; x < small->size().width; x++)
      REQUIRE(larger->at(x + options.origin[0], y + options.origin[1]) == small->at(x, y));
  options.whole_bricks = false;
  CHECK(hybrids(stones, *made(*index, options)) > 0.15);
}

TEST_CASE("drafts, and results that ask for no whole bricks, are made as without elements") {
  const DrawnStones stones(exemplar);
  const IndexPtr plain = index_of(stones, false), known = index_of(stones, true);
  for (const SynthesisOptions& options : {SynthesisOptions{.size = {150, 150}, .quality = Quality::draft},
                                          SynthesisOptions{.size = {150, 150}, .whole_bricks = false}})
    CHECK(made(*plain, options)->pixels() == made(*known, options)->pixels());
}

TEST_CASE("elements that are too few, or not known, are not laid") {
  const DrawnStones stones(exemplar);
  const auto knows = [&](const Elements& e, bool wraps) {
    const FeaturesPtr features = plain_features(stones.image(), wraps)->with(std::make_shared<const Elements>(e));
    return has_elements(*make_appearance(*features, {}, {}, task));
  };
  CHECK(knows(stones.elements(), true));
  CHECK_FALSE(knows(DrawnStones(exemplar, 2).elements(), false));
  CHECK_FALSE(has_elements(*index_of(stones, false)->appearance()));
}

TEST_CASE("elements of a lattice come whole, and in phase with it") {
  const DrawnTiles tiles(72);
  const SynthesisOptions options{.size = {520, 500}, .seed = 2};
  const UvMapPtr uv = synthesize(*tiles.index(true), options, task);
  CHECK(hybrid_elements(*uv, tiles.elements, task).by_area < 0.02);
  std::map<std::pair<int, int>, int> phases;
  for (int y = 0; y < 500; y++)
    for (int x = 0; x < 520; x++) phases[{wrap(uv->at(x, y).x - x, 72), wrap(uv->at(x, y).y - y, 72)}]++;
  int most = 0;
  for (const auto& [phase, count] : phases) most = std::max(most, count);
  CHECK(most > 0.97 * 520 * 500);
}

TEST_CASE("elements of a lattice are rigid, however crooked their borders were found") {
  const UvMapPtr uv = synthesize(*DrawnTiles(72).crooked().index(true), {.size = {520, 500}, .seed = 2}, task);
  const ExemplarPixel first = uv->at(0, 0);
  const int phase_x = wrap(int(first.x), 72), phase_y = wrap(int(first.y), 72);
  int in_phase = 0;
  for (int y = 0; y < 500; y++)
    for (int x = 0; x < 520; x++)
      in_phase += wrap(uv->at(x, y).x - x - phase_x, 72) == 0 && wrap(uv->at(x, y).y - y - phase_y, 72) == 0;
  CHECK(in_phase > 0.99 * 520 * 500);
}

namespace {

/// Courses of two heights in turn, of stones of all lengths.
struct DrawnCourses {
  static constexpr int low = 40, high = 80, across = 5;
  Elements elements{exemplar, {}, 0, 1};
  std::vector<float> pixels;

  DrawnCourses() {
    for (int y = 0; y < exemplar.height; y++)
      for (int x = 0; x < exemplar.width; x++) {
        const int pair = y / (low + high), within = y % (low + high);
        const int course = 2 * pair + (within >= low);
        const int from_top = within < low ? within : within - low, height = within < low ? low : high;
        int stone = 0;
        while (stone + 1 < across && x >= joint(course, stone + 1)) stone++;
        const int next = stone + 1 < across ? joint(course, stone + 1) : exemplar.width + joint(course, 0);
        const int last = x < joint(course, 0) ? across - 1 : stone;
        const int left = x < joint(course, 0) ? joint(course, across - 1) - exemplar.width : joint(course, stone);
        const int right = x < joint(course, 0) ? joint(course, 0) : next;
        elements.at.push_back(uint16_t(course * across + last));
        const bool is_joint = std::min({x - left, right - 1 - x, from_top, height - 1 - from_top}) < 2;
        const double shade = 0.4 + 0.5 * unit_double(random_bits(5, course, last));
        pixels.push_back(float((is_joint ? 0.1 : shade) + 0.05 * unit_double(random_bits(3, x, y))));
      }
    elements.count = 4 * across;
  }
  static int joint(int course, int stone) {
    return stone * exemplar.width / across + int(below(uint32_t(random_bits(9, course, stone)), 24));
  }
};

}  // namespace

TEST_CASE("elements of courses stay at the height of their course") {
  const DrawnCourses wall;
  const ImagePtr image = make_image(
      exemplar, 1, [&](int x, int y, int) { return wall.pixels[size_t(y) * size_t(exemplar.width) + size_t(x)]; });
  const Lattice lattice{1, {0, double(DrawnCourses::low + DrawnCourses::high)}, {}, 0.5};
  const FeaturesPtr features =
      plain_features(image, true)->with(lattice)->with(std::make_shared<const Elements>(wall.elements));
  const UvMapPtr uv = made(*make_index(make_appearance(*features, {}, {}, task), 3, task), {.size = {500, 480}});
  CHECK(hybrid_elements(*uv, wall.elements, task).by_area < 0.05);
  std::map<int, int> heights;
  for (int y = 0; y < 480; y++)
    for (int x = 0; x < 500; x++) heights[wrap(uv->at(x, y).y - y, DrawnCourses::low + DrawnCourses::high)]++;
  int most = 0;
  for (const auto& [height, count] : heights) most = std::max(most, count);
  CHECK(most > 0.9 * 500 * 480);
}

TEST_CASE("laid stones do not depend on the number of threads, nor on how a surface is cut into parts") {
  const DrawnStones stones(exemplar);
  double certainty = 1;
  SUBCASE("bent") {}
  SUBCASE("heaped") {
    certainty = 0.3;
  }
  const IndexPtr index = index_of(stones, true, true, certainty);
  const SynthesisOptions options{.size = {220, 200}, .seed = 5};
  const auto with = [&](int threads) {
    tbb::task_arena arena(threads);
    return arena.execute([&] { return made(*index, options); });
  };
  const UvMapPtr one = with(1);
  CHECK(one->pixels() == with(4)->pixels());
  const UvMapPtr coarse = coarse_uv(*index, options, task);
  const Rect part{90, 40, 70, 100};
  const UvMapPtr refined = refine(*index, *coarse, options, part, task);
  for (int y = 0; y < part.height; y++)
    for (int x = 0; x < part.width; x++) REQUIRE(refined->at(x, y) == one->at(part.x + x, part.y + y));
}
