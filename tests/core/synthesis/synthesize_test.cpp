#include "core/synthesis/synthesize.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <mutex>
#include <set>

#include <doctest/doctest.h>
#include <tbb/task_arena.h>

#include "tests/exemplars.h"

using namespace terrazzo;
using namespace terrazzo::test;

namespace {

const Index& index() {
  static const IndexPtr made = wall_index();
  return *made;
}

/// How many neighbouring output pixels show neighbouring exemplar pixels.
double coherent_share(const UvMap& uv) {
  int coherent = 0, all = 0;
  for (int y = 0; y < uv.size().height; y++)
    for (int x = 0; x + 1 < uv.size().width; x++, all++) {
      const ExemplarPixel a = uv.at(x, y), b = uv.at(x + 1, y);
      coherent += b.x == a.x + 1 && b.y == a.y;
    }
  return double(coherent) / all;
}

}  // namespace

TEST_CASE("progress goes on while the finest level is corrected, most of the time") {
  std::mutex mutex;
  std::set<double> told{0.0, 1.0};
  const Task task(nullptr, [&](double fraction) {
    const std::lock_guard lock(mutex);
    told.insert(fraction);
  });
  synthesize(index(), {.size = {600, 600}}, task);
  double longest = 0;
  for (auto at = told.begin(); std::next(at) != told.end(); ++at) longest = std::max(longest, *std::next(at) - *at);
  CHECK(longest < 0.25);
  CHECK(*told.rbegin() == 1);
}

TEST_CASE("the same seed gives the same uv map on any number of threads, another seed another") {
  const SynthesisOptions options{.size = {60, 44}, .seed = 7};
  std::set<Digest> digests;
  for (const int threads : {1, 2, 4})
    tbb::task_arena(threads).execute([&] { digests.insert(synthesize(index(), options, Task())->digest()); });
  CHECK(digests.size() == 1);
  digests.insert(synthesize(index(), {.size = {60, 44}, .seed = 8}, Task())->digest());
  CHECK(digests.size() == 2);
}

TEST_CASE("any output size works, down to a single pixel") {
  for (const Size size : {Size{1, 1}, Size{1, 40}, Size{33, 2}, Size{17, 91}, Size{128, 128}}) {
    const UvMapPtr uv = synthesize(index(), {.size = size, .tile_x = true, .tile_y = true}, Task());
    CHECK(uv->size() == size);
    CHECK(uv->exemplar() == Size{48, 40});
  }
}

TEST_CASE("the result is made of coherent pieces, not of one copy") {
  const UvMapPtr uv = synthesize(index(), {.size = {96, 96}}, Task());
  CHECK(coherent_share(*uv) > 0.55);
  CHECK(coherent_share(*uv) < 0.999);
}

TEST_CASE("windows stay inside an exemplar that does not tile, but for one row where it is small") {
  const UvMapPtr uv = synthesize(index(), {.size = {96, 96}}, Task());
  for (const ExemplarPixel p : uv->pixels()) {
    REQUIRE(p.x >= 1);
    REQUIRE(p.y >= 1);
    REQUIRE(p.x < 47);
    REQUIRE(p.y < 39);
  }
}

TEST_CASE("evenness spreads the use of the exemplar") {
  const auto used_pixels = [](double evenness) {
    const UvMapPtr uv = synthesize(index(), {.size = {96, 96}, .evenness = evenness}, Task());
    std::set<uint32_t> used;
    for (const ExemplarPixel p : uv->pixels()) used.insert(uint32_t(p.y) << 16 | p.x);
    return used.size();
  };
  CHECK(used_pixels(2) > used_pixels(0));
}

TEST_CASE("what shows at a place seldom shows again near by") {
  const Size size{128, 128};
  const ImagePtr image = make_image(
      size, 1,
      [](int x, int y, int) {
        return float(0.7 * unit_double(random_bits(3, x / 6, y / 6)) + 0.3 * unit_double(random_bits(4, x, y)));
      },
      Semantic::height, "raw");
  const IndexPtr exemplar = make_index(make_appearance(*plain_features(image), {}, {}, Task()), 3, Task());
  constexpr int near = 48, piece = 12;
  /// The part of the pixels that show again nearer than that, with what lies around them.
  const auto shown_again = [&](double evenness, uint64_t seed) {
    const UvMapPtr uv = synthesize(*exemplar, {.size = {256, 256}, .seed = seed, .evenness = evenness}, Task());
    std::vector<std::vector<std::array<int, 2>>> places(size_t(size.area()));
    const auto goes_on = [&](int x, int y) {
      const ExemplarPixel a = uv->at(x, y), b = uv->at(x + piece, y + piece);
      return b.x == a.x + piece && b.y == a.y + piece;
    };
    int again = 0;
    for (int y = 0; y + piece < 256; y++)
      for (int x = 0; x + piece < 256; x++) {
        if (!goes_on(x, y)) continue;
        auto& same = places[size_t(uv->at(x, y).y) * size.width + uv->at(x, y).x];
        again += std::ranges::any_of(same, [&](const std::array<int, 2>& p) {
          return (x - p[0]) * (x - p[0]) + (y - p[1]) * (y - p[1]) < near * near;
        });
        same.push_back({x, y});
      }
    return again / (256.0 * 256.0);
  };
  double careless = 0, careful = 0;
  for (uint64_t seed = 1; seed <= 3; seed++) {
    careless += shown_again(0, seed) / 3;
    careful += shown_again(0.7, seed) / 3;
  }
  CHECK(careful < careless / 5);
}

TEST_CASE("an even use leaves no crumbs of small exemplars") {
  // Beans on dark ground.
  const Size size{64, 64};
  const auto bean = [](int x, int y) {
    double nearest = 1e9, shade = 0;
    for (int j = y / 9 - 1; j <= y / 9 + 1; j++)
      for (int i = x / 9 - 1; i <= x / 9 + 1; i++) {
        const uint64_t bits = random_bits(5, i, j);
        const double dx = x - 9 * i - 9 * unit_double(bits), dy = y - 9 * j - 9 * unit_double(random_bits(bits, 1));
        const double d = dx * dx + 2 * dy * dy;
        if (d >= nearest) continue;
        nearest = d;
        shade = 0.5 + 0.4 * unit_double(random_bits(bits, 2));
      }
    return float(nearest < 30 ? shade - nearest / 100 : 0.1);
  };
  const ImagePtr image = make_image(
      size, 1, [&](int x, int y, int) { return bean(x, y); }, Semantic::height, "raw");
  const IndexPtr exemplar = make_index(make_appearance(*plain_features(image), {}, {}, Task()), 3, Task());
  /// The part of the pixels that continue none of the four around them.
  const auto crumbs = [&](double evenness) {
    int alone = 0;
    for (uint64_t seed = 1; seed <= 3; seed++) {
      const UvMapPtr uv = synthesize(*exemplar, {.size = {192, 192}, .seed = seed, .evenness = evenness}, Task());
      const auto goes_on = [&](int x, int y, int dx, int dy) {
        const ExemplarPixel a = uv->at(x, y), b = uv->at(x + dx, y + dy);
        return b.x == a.x + dx && b.y == a.y + dy;
      };
      for (int y = 1; y < 191; y++)
        for (int x = 1; x < 191; x++)
          alone += !goes_on(x, y, 1, 0) && !goes_on(x, y, -1, 0) && !goes_on(x, y, 0, 1) && !goes_on(x, y, 0, -1);
    }
    return alone / (3 * 190.0 * 190.0);
  };
  const double careless = crumbs(0), even = crumbs(0.7);
  CHECK(even < 1.5 * careless);
}

TEST_CASE("rare features come about as often as in the exemplar") {
  const Size size{128, 128};
  const auto is_crack = [](int x, int y) {
    return std::abs(y - 64 - 20 * std::sin(x / 20.0)) < 2.5 - std::abs(x - 64) / 25.0;
  };
  const ImagePtr image = make_image(
      size, 1,
      [&](int x, int y, int) {
        const double blotch = unit_double(random_bits(3, x / 5, y / 5)), speckle = unit_double(random_bits(4, x, y));
        return float(is_crack(x, y) ? 0.05 : 0.5 + 0.3 * blotch + 0.15 * speckle);
      },
      Semantic::height, "raw");
  const IndexPtr exemplar = make_index(make_appearance(*plain_features(image), {}, {}, Task()), 3, Task());
  const auto share = [&](const auto& pixels, auto&& at) {
    return double(std::ranges::count_if(pixels, at)) / double(pixels.size());
  };
  double wanted = 0, shown = 0;
  for (int y = 0; y < size.height; y++)
    for (int x = 0; x < size.width; x++) wanted += is_crack(x, y) / double(size.area());
  constexpr int seeds = 4;
  for (uint64_t seed = 1; seed <= seeds; seed++) {
    const UvMapPtr uv = synthesize(*exemplar, {.size = {256, 256}, .seed = seed}, Task());
    const double one = share(uv->pixels(), [&](const ExemplarPixel& p) { return is_crack(p.x, p.y); });
    CHECK(one > 0.6 * wanted);
    shown += one / seeds;
  }
  CHECK(shown > 0.75 * wanted);
  CHECK(shown < 1.35 * wanted);
}

TEST_CASE("less coherence makes smaller pieces") {
  const UvMapPtr large = synthesize(index(), {.size = {96, 96}, .coherence = 0.4}, Task());
  const UvMapPtr small = synthesize(index(), {.size = {96, 96}, .coherence = 1}, Task());
  CHECK(coherent_share(*large) > coherent_share(*small));
}

TEST_CASE("a tileable result fits together across its borders as well as inside") {
  const ImagePtr exemplar = wall({48, 40});
  const UvMapPtr uv = synthesize(index(), {.size = {64, 64}, .tile_x = true, .tile_y = true}, Task());
  const auto red = [&](int x, int y) {
    const ExemplarPixel p = uv->at(wrap(x, 64), wrap(y, 64));
    return exemplar->in_memory()[(p.y * 48 + p.x) * 3];
  };
  double seam = 0, inside = 0;
  for (int y = 0; y < 64; y++) {
    seam += std::abs(red(63, y) - red(64, y)) + std::abs(red(y, 63) - red(y, 64));
    for (int x = 0; x < 62; x++) inside += std::abs(red(x, y) - red(x + 1, y)) + std::abs(red(y, x) - red(y, x + 1));
  }
  CHECK(seam < 1.6 * inside / 62);
}

TEST_CASE("the borders of a tileable result have hardly more seams than its inside") {
  constexpr int side = 256;
  const IndexPtr exemplar = wall_index({side, side});
  double border = 0, all = 0;
  for (uint64_t seed = 1; seed <= 24; seed++) {
    const UvMapPtr uv =
        synthesize(*exemplar, {.size = {side, side}, .seed = seed, .tile_x = true, .tile_y = true}, Task());
    const auto is_seam = [&](int x, int y, int dx, int dy) {
      const ExemplarPixel a = uv->at(x, y), b = uv->at((x + dx) % side, (y + dy) % side);
      return a.x + dx != b.x || a.y + dy != b.y;
    };
    for (int i = 0; i < side; i++) {
      border += is_seam(side - 1, i, 1, 0) + is_seam(i, side - 1, 0, 1);
      for (int k = 0; k < side; k++) all += double(is_seam(k, i, 1, 0) + is_seam(i, k, 0, 1)) / side;
    }
  }
  CHECK(border < 1.2 * all);
}

TEST_CASE("jitter breaks pieces up on the levels that have some, coarsest first") {
  const auto made = [](std::vector<double> jitter) {
    return synthesize(index(), {.size = {96, 96}, .jitter = std::move(jitter)}, Task());
  };
  const UvMapPtr still = made({});
  CHECK(made({0, 0})->digest() == still->digest());
  for (const std::vector<double>& jitter : {std::vector<double>{4}, {0, 4}}) {
    const UvMapPtr moved = made(jitter);
    CHECK(coherent_share(*moved) < 0.95 * coherent_share(*still));
    std::vector<double> longer = jitter;
    longer.push_back(0);
    CHECK(made(longer)->digest() == moved->digest());
  }
}

TEST_CASE("a cancelled synthesis stops") {
  const std::atomic<bool> cancelled{true};
  CHECK_THROWS_AS(synthesize(index(), {.size = {50, 50}}, Task(&cancelled, {})), Cancelled);
}

TEST_CASE("cells larger than the exemplar lead around one that tiles, and nowhere else") {
  const AppearancePtr found = make_appearance(*plain_features(wall({48, 40}), true), {}, {}, Task());
  for (const Lattice& lattice : {Lattice{1, {0, 700}, {}, 1}, Lattice{2, {900, 0}, {800, 500}, 1}}) {
    const IndexPtr regular = make_index(Appearance::make(found->levels(), found->channels(), true, lattice), 3, Task());
    const UvMapPtr uv = synthesize(*regular, {.size = {30, 300}, .jitter = {2, 2}}, Task());
    for (const ExemplarPixel p : uv->pixels()) {
      REQUIRE(p.x < 48);
      REQUIRE(p.y < 40);
    }
  }
}
