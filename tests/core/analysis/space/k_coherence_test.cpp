#include "core/analysis/space/k_coherence.h"

#include <algorithm>

#include <doctest/doctest.h>
#include <tbb/task_arena.h>

#include "tests/exemplars.h"

using namespace terrazzo;
using namespace terrazzo::test;

TEST_CASE("in a periodic exemplar, similar pixels lie whole periods apart") {
  const ImagePtr dots = make_image({128, 128}, 1, [](int x, int y, int) {
    const int dx = x % 32 - 16, dy = y % 32 - 16;
    return dx * dx + dy * dy < 80 ? 1.f : float((x % 32) * 0.005 + (y % 32) * 0.01);
  });
  const IndexPtr index = make_index(make_appearance(*plain_features(dots, true), {}, {}, Task()), 3, Task());
  int whole = 0, all = 0;
  for (int i = 0; i < 64 * 64; i++)
    for (int k = 0; k < 3; k++) {
      const uint32_t p = index->levels()[1].positions[i * 3 + k];
      whole += (int(p % 64) - i % 64) % 16 == 0 && (int(p / 64) - i / 64) % 16 == 0;
      all++;
    }
  CHECK(whole > all * 9 / 10);
}

TEST_CASE("members of a set keep apart from the pixel and from one another") {
  const IndexPtr index = wall_index({160, 144});
  const std::vector<uint32_t>& positions = index->levels()[1].positions;
  for (int i = 0; i < 80 * 72; i++)
    for (int k = 0; k < 3; k++) {
      const int x = int(positions[i * 3 + k] % 80), y = int(positions[i * 3 + k] / 80);
      REQUIRE(std::max(std::abs(x - i % 80), std::abs(y - i / 80)) >= 3);
      for (int j = 0; j < k; j++) {
        const int u = int(positions[i * 3 + j] % 80), v = int(positions[i * 3 + j] / 80);
        REQUIRE(std::max(std::abs(x - u), std::abs(y - v)) >= 3);
      }
    }
}

TEST_CASE("similar sets do not depend on the number of threads, for narrow exemplars neither") {
  for (const Size size : {Size{64, 48}, Size{16, 200}}) {
    Digest one, four;
    tbb::task_arena(1).execute([&] { one = wall_index(size)->digest(); });
    tbb::task_arena(4).execute([&] { four = wall_index(size)->digest(); });
    CHECK(one == four);
  }
}

TEST_CASE("the search goes around an exemplar that tiles as often as it takes") {
  for (const Size size : {Size{16, 200}, Size{300, 24}}) {
    const IndexPtr index = wall_index(size, true);
    for (const SimilarSets& level : index->levels()) {
      if (level.per_pixel == 0) continue;
      const auto pixels = uint32_t(level.positions.size()) / uint32_t(level.per_pixel);
      CHECK(*std::max_element(level.positions.begin(), level.positions.end()) < pixels);
    }
  }
}

TEST_CASE("the finest level has no similar sets, unless it is the only one") {
  for (const Size size : {Size{64, 48}, Size{16, 200}}) {
    const IndexPtr index = wall_index(size);
    CHECK((index->levels()[0].per_pixel == 0) == (index->levels().size() > 1));
    CHECK(index->levels().back().per_pixel > 0);
  }
}
