#include "core/numeric/grid_cut.h"

#include <doctest/doctest.h>

#include "core/base/hash.h"

using namespace terrazzo;

namespace {

constexpr int width = 4, height = 3, count = width * height;

struct Problem {
  int64_t prefer[count];
  int64_t right[count], left[count], down[count], up[count];  // costs of joins with the next column and row
};

Problem random_problem(uint64_t seed) {
  Problem p{};
  int n = 0;
  const auto draw = [&](uint32_t most) { return int64_t(below(uint32_t(random_bits(seed, n++)), most)); };
  for (int i = 0; i < count; i++) {
    // Where few nodes prefer a side, ways are long and use one another's joins.
    p.prefer[i] = seed % 2 == 0 || i % 5 == 0 ? draw(21) - 10 : 0;
    p.right[i] = draw(8);
    p.left[i] = draw(8);
    p.down[i] = draw(8);
    p.up[i] = draw(8);
  }
  return p;
}

int64_t cost(const Problem& p, unsigned source) {
  const auto in = [&](int i) { return (source >> i & 1) != 0; };
  int64_t sum = 0;
  for (int i = 0; i < count; i++) {
    if (!in(i)) sum += p.prefer[i];
    if (i % width + 1 < width) sum += in(i) && !in(i + 1) ? p.right[i] : !in(i) && in(i + 1) ? p.left[i] : 0;
    if (i + width < count) sum += in(i) && !in(i + width) ? p.down[i] : !in(i) && in(i + width) ? p.up[i] : 0;
  }
  return sum;
}

unsigned cut(const Problem& p) {
  GridCut graph;
  graph.reset(count);
  for (int i = 0; i < count; i++) {
    graph.prefer_source(i, p.prefer[i]);
    if (i % width + 1 < width) {
      graph.join(i, 0, i + 1, p.right[i]);
      graph.join(i + 1, 2, i, p.left[i]);
    }
    if (i + width < count) {
      graph.join(i, 1, i + width, p.down[i]);
      graph.join(i + width, 3, i, p.up[i]);
    }
  }
  graph.solve();
  unsigned source = 0;
  for (int i = 0; i < count; i++) source |= unsigned(graph.on_source_side(i)) << i;
  return source;
}

}  // namespace

TEST_CASE("no other cut is cheaper, and none that costs the same has fewer nodes on the source's side") {
  for (uint64_t seed = 0; seed < 120; seed++) {
    CAPTURE(seed);
    const Problem p = random_problem(seed);
    const unsigned found = cut(p);
    int64_t least = cost(p, 0);
    int fewest = 0;
    for (unsigned source = 1; source < 1u << count; source++) {
      const int64_t c = cost(p, source);
      if (c > least || (c == least && __builtin_popcount(source) >= fewest)) continue;
      least = c;
      fewest = __builtin_popcount(source);
    }
    CHECK(cost(p, found) == least);
    CHECK(__builtin_popcount(found) == fewest);
  }
}
