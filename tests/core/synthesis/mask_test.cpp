#include <set>

#include <doctest/doctest.h>
#include <tbb/task_arena.h>

#include "core/synthesis/synthesize.h"
#include "tests/exemplars.h"

using namespace terrazzo;
using namespace terrazzo::test;

namespace {

bool in_ring(int x, int y) {
  const int d = (x - 30) * (x - 30) + (y - 26) * (y - 26);
  return d < 20 * 20 && d > 6 * 6;
}

IndexPtr masked_index(bool (*allowed)(int, int), bool wraps = false) {
  const Size size{60, 52};
  const ImagePtr mask = make_image(size, 1, [&](int x, int y, int) { return allowed(x, y) ? 1.0f : 0.0f; });
  const FeaturesPtr features =
      Features::make(size, {{wall(size), {1.0, 1.0, 1.0}}}, wraps, Lattice{2, {16, 0}, {8, 8}, 1}, mask);
  return make_index(make_appearance(*features, {}, {}, Task()), 3, Task());
}

bool shows_only(const UvMap& uv, bool (*allowed)(int, int)) {
  return std::all_of(uv.pixels().begin(), uv.pixels().end(), [&](ExemplarPixel p) { return allowed(p.x, p.y); });
}

}  // namespace

TEST_CASE("no output pixel shows what the mask forbids, whatever its shape") {
  const auto dot = [](int x, int y) { return x == 17 && y == 3; };
  const auto corners = [](int x, int y) { return (x < 9 || x > 50) && (y < 9 || y > 44); };
  const auto dust = [](int x, int y) { return random_bits(3, x, y) % 7 == 0; };
  for (const bool wraps : {false, true})
    for (bool (*allowed)(int, int) : {+in_ring, +dot, +corners, +dust}) {
      const IndexPtr index = masked_index(allowed, wraps);
      CHECK(shows_only(*synthesize(*index, {.size = {70, 64}, .jitter = {2, 2, 2}}, Task()), allowed));
    }
}

TEST_CASE("a masked synthesis is the same on any number of threads") {
  const IndexPtr index = masked_index(in_ring);
  std::set<Digest> digests;
  for (const int threads : {1, 2, 4})
    tbb::task_arena(threads).execute([&] {
      digests.insert(synthesize(*index, {.size = {64, 60}, .tile_x = true, .tile_y = true}, Task())->digest());
    });
  CHECK(digests.size() == 1);
}

TEST_CASE("a mask that allows all leaves the whole exemplar in use") {
  const IndexPtr index = masked_index([](int, int) { return true; });
  const UvMapPtr uv = synthesize(*index, {.size = {120, 120}}, Task());
  std::set<std::pair<int, int>> used;
  for (const ExemplarPixel p : uv->pixels()) used.insert({p.x, p.y});
  CHECK(used.size() > 56 * 48 / 2);
}
