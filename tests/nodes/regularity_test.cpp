#include "core/analysis/regularity.h"

#include <doctest/doctest.h>

#include "core/error.h"
#include "nodes/registry.h"
#include "tests/exemplars.h"

using namespace terrazzo;
using namespace terrazzo::test;

namespace {

FeaturesPtr features_of(Size size, const std::function<float(int, int)>& value) {
  return plain_features(make_image(
      size, 1, [&](int x, int y, int) { return value(x, y) + 0.1f * float(unit_double(random_bits(3, x, y))); }));
}

Lattice lattice_of(const FeaturesPtr& features, const Params& params = {}) {
  return run_node("regularity", params, {{"features", {features}}}).get<Features>("features")->lattice();
}

}  // namespace

TEST_CASE("a grid of tiles is found with its periods") {
  const Lattice l =
      lattice_of(features_of({128, 120}, [](int x, int y) { return x % 16 == 0 || y % 12 == 0 ? 1.f : 0.f; }));
  REQUIRE(l.rank == 2);
  CHECK(l.first.x == doctest::Approx(16).epsilon(0.01));
  CHECK(l.second.y == doctest::Approx(12).epsilon(0.01));
  CHECK(l.certainty > 0.3);
}

TEST_CASE("courses of bricks of random length are found as courses") {
  const Lattice l = lattice_of(features_of({128, 128}, [](int x, int y) {
    const bool end = below(uint32_t(random_bits(8, x, y / 9)), 11) == 0;
    return y % 9 == 0 || end ? 1.f : 0.f;
  }));
  REQUIRE(l.rank == 1);
  CHECK(l.first.x == 0);
  CHECK(l.first.y == doctest::Approx(9).epsilon(0.01));
}

TEST_CASE("noise has no lattice") {
  CHECK(lattice_of(features_of({96, 96}, [](int x, int y) {
          return float(unit_double(random_bits(4, x / 3, y / 3)));
        })).rank == 0);
}

TEST_CASE("a manual lattice is taken as it is, off takes none") {
  const FeaturesPtr features = plain_features(wall({48, 48}));
  const Lattice manual = lattice_of(features, {{"mode", std::string("manual")}, {"first", Numbers{0, 8.5}}});
  CHECK(manual.rank == 1);
  CHECK(manual.first.y == 8.5);
  CHECK(lattice_of(features, {{"mode", std::string("off")}}).rank == 0);
}

TEST_CASE("a manual lattice that is none is refused when the graph is checked") {
  const NodeType* type = find_node_type("regularity");
  Params params{{"mode", std::string("manual")}, {"first", Numbers{}}, {"second", Numbers{}}};
  CHECK(type->check(params).size() == 1);
  params["first"] = Numbers{3, 4};
  CHECK(type->check(params).size() == 1);
  params["second"] = Numbers{6, 8};
  CHECK(type->check(params).size() == 1);
  params["second"] = Numbers{6, 0};
  CHECK(type->check(params).empty());
}

TEST_CASE("a result that wraps holds a whole number of cells, and positions one cell apart are in phase") {
  const Lattice grid{2, {10.3, 0}, {0, 7.9}, 1};
  const LatticePhase phase(grid, 0, {100, 80}, true, true);
  REQUIRE(phase.active());
  for (const int x : {0, 13, 99}) {
    const Vector2 here = phase.excess(5, 6, x, 20), around = phase.excess(5, 6, x - 100, 20 + 80);
    CHECK(here.x == doctest::Approx(around.x));
    CHECK(here.y == doctest::Approx(around.y));
  }
  int u = 50, v = 33;
  phase.snap(3, 4, u, v);
  CHECK(phase.penalty(u, v, 3, 4) == 1.0);
}
