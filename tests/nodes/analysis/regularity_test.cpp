#include "core/analysis/repeats/regularity.h"

#include <cmath>
#include <limits>

#include <doctest/doctest.h>

#include "core/base/error.h"
#include "nodes/common/registry.h"
#include "tests/exemplars.h"
#include "tests/lattices.h"

using namespace terrazzo;
using namespace terrazzo::test;

namespace {

FeaturesPtr features_of(Size size, const std::function<float(int, int)>& value, bool wraps = false) {
  return plain_features(
      make_image(size, 1,
                 [&](int x, int y, int) { return value(x, y) + 0.1f * float(unit_double(random_bits(3, x, y))); }),
      wraps);
}

/// Tiles of one width and height, each of its own shade, with joints of two pixels.
std::function<float(int, int)> tiles(int width, int height) {
  return [=](int x, int y) {
    return x % width < 2 || y % height < 2 ? 1.f : 0.5f * float(unit_double(random_bits(6, x / width, y / height)));
  };
}

Lattice lattice_of(const FeaturesPtr& features, const Params& params = {}) {
  return run_node("regularity", params, {{"features", {features}}}).get<Features>("features")->repeats().lattice;
}

/// Bricks of 16x8 pixels in herringbone, each of its own shade, with light joints.
float herringbone(int x, int y) {
  const int column = x / 8, row = y / 8;
  const int kind = wrap(column - row, 4);  // the left and right half of a lying brick; the foot and head of one upright
  const bool joint = kind == 0   ? x % 8 == 0 || y % 8 == 0
                     : kind == 1 ? y % 8 == 0
                     : kind == 2 ? x % 8 == 0
                                 : x % 8 == 0 || y % 8 == 0;
  const int first_column = kind == 1 ? column - 1 : column, first_row = kind == 2 ? row - 1 : row;
  return joint ? 1.f : 0.6f * float(unit_double(random_bits(5, first_column, first_row)));
}

}  // namespace

TEST_CASE("tiles are found by their joints where their shades differ") {
  const Lattice l = lattice_of(features_of({128, 120}, [](int x, int y) {
    return x % 16 == 0 || y % 12 == 0 ? 0.6f : float(unit_double(random_bits(6, x / 16, y / 12)));
  }));
  REQUIRE(l.rank == 2);
  CHECK(std::abs(l.first.x() * l.second.y() - l.first.y() * l.second.x()) == doctest::Approx(192).epsilon(0.02));
  CHECK(repeats_by(l, 16, 0));
  CHECK(repeats_by(l, 0, 12));
}

TEST_CASE("an exemplar that is one tile is warned of, as a result repeats it; one of four tiles is not") {
  const auto warns = [](int width, int height) {
    return run_node("regularity", {}, {{"features", {features_of({128, 128}, tiles(width, height), true)}}})
        .says("a single cell of its lattice");
  };
  CHECK(warns(128, 128));
  CHECK_FALSE(warns(64, 64));
}

TEST_CASE("the grid on which a herringbone's joints lie is not taken for its lattice") {
  const Lattice l = lattice_of(features_of({128, 128}, herringbone));
  REQUIRE(l.rank == 2);
  CAPTURE(l.first.x());
  CAPTURE(l.first.y());
  CAPTURE(l.second.x());
  CAPTURE(l.second.y());
  CAPTURE(l.certainty);
  CHECK(repeats_by(l, 8, 8));
  CHECK(repeats_by(l, 32, 0));
  CHECK(!repeats_by(l, 8, 0));
  CHECK(!repeats_by(l, 16, 0));
}

TEST_CASE("a grid of tiles is found with its periods") {
  const Lattice l =
      lattice_of(features_of({128, 120}, [](int x, int y) { return x % 16 == 0 || y % 12 == 0 ? 1.f : 0.f; }));
  REQUIRE(l.rank == 2);
  CHECK(l.first.x() == doctest::Approx(16).epsilon(0.01));
  CHECK(l.second.y() == doctest::Approx(12).epsilon(0.01));
  CHECK(l.certainty > 0.3);
}

TEST_CASE("courses of bricks of random length are found as courses") {
  const Lattice l = lattice_of(features_of({128, 128}, [](int x, int y) {
    const bool end = below(uint32_t(random_bits(8, x, y / 9)), 11) == 0;
    return y % 9 == 0 || end ? 1.f : 0.f;
  }));
  REQUIRE(l.rank == 1);
  CHECK(l.first.x() == 0);
  CHECK(l.first.y() == doctest::Approx(9).epsilon(0.01));
}

TEST_CASE("a node that finds no lattice says what it found, and what was asked for") {
  const auto note_of = [](float alike) {
    const FeaturesPtr features = features_of({126, 126}, [alike](int x, int y) {
      const auto noise = [](int u, int v, uint64_t seed) {
        return float(unit_double(random_bits(seed, u / 3, v / 3)));
      };
      return alike * noise(x % 63, y % 63, 4) + (1 - alike) * noise(x, y, 5);
    });
    return run_node("regularity", {}, {{"features", {features}}}).notes.front();
  };
  CHECK(note_of(0).starts_with("no lattice found (certainty 0.0"));
  CHECK(note_of(0).ends_with(", below \"least_certainty\" 0.08)"));
  // Four cells of which no two are much alike.
  CHECK(note_of(0.5f).starts_with("no lattice found: too few repeats, or too unlike, to be sure (certainty 0."));
}

TEST_CASE("noise has no lattice") {
  CHECK(lattice_of(features_of({96, 96}, [](int x, int y) {
          return float(unit_double(random_bits(4, x / 3, y / 3)));
        })).rank == 0);
}

TEST_CASE("exemplars too small to hold repeats have no lattice") {
  for (const Size size : {Size{1, 1}, Size{4, 3}, Size{40, 2}})
    CHECK(lattice_of(features_of(size, [](int x, int) { return float(x % 2); })).rank == 0);
}

TEST_CASE("a manual lattice is taken as it is, off takes none") {
  const FeaturesPtr features = plain_features(wall({48, 48}));
  const Lattice manual = lattice_of(features, {{"mode", std::string("manual")}, {"first", Numbers{0, 8.5}}});
  CHECK(manual.rank == 1);
  CHECK(manual.first.y() == 8.5);
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
  params["first"] = Numbers{0, 0.1};
  CHECK(type->check(params) == std::vector<std::string>{"\"first\": expected a vector at least one pixel long"});
}

namespace {

constexpr Size two_parts{260, 96};

/// Tiles of 16x12 pixels on the left, of 16x12 that begin elsewhere or of 22x18 on the right.
FeaturesPtr side_by_side(bool alike) {
  return features_of(two_parts, [=](int x, int y) {
    if (x < 130) return tiles(16, 12)(x, y);
    return alike ? tiles(16, 12)(x + 3, y + 5) : tiles(22, 18)(x, y);
  });
}

ImagePtr labels_of(const std::function<float(int, int)>& value, Size size = two_parts) {
  return make_image(size, 1, [&](int x, int y, int) { return value(x, y); });
}

NodeRun run_with_labels(const FeaturesPtr& features, const ImagePtr& labels, const Params& params = {}) {
  return run_node("regularity", params, {{"features", {features}}, {"labels", {labels}}});
}

const ImagePtr& halves() {
  static const ImagePtr labels = labels_of([](int x, int) { return x < 130 ? 0.f : 1.f; });
  return labels;
}

}  // namespace

TEST_CASE("of several exemplars side by side each has its own lattice") {
  const NodeRun run = run_with_labels(side_by_side(false), halves());
  const Repeats repeats = run.get<Features>("features")->repeats();
  REQUIRE(repeats.parts.size() == 2);
  CHECK(repeats.parts[0].place == Rect{0, 0, 130, 96});
  CHECK(repeats.parts[1].place == Rect{130, 0, 130, 96});
  CHECK(repeats.parts[0].lattice.cell_area() == doctest::Approx(16 * 12).epsilon(0.03));
  CHECK(repeats.parts[1].lattice.cell_area() == doctest::Approx(22 * 18).epsilon(0.03));
  REQUIRE(run.notes.size() == 1);
  CHECK(run.notes.front().find("exemplar 2: repeats by") != std::string::npos);
}

TEST_CASE("exemplars that repeat alike are brought into phase") {
  for (const char* mode : {"auto", "manual"}) {
    CAPTURE(mode);
    Params params{{"mode", std::string(mode)}};
    if (params["mode"] == ParamValue(std::string("manual"))) {
      params["first"] = Numbers{16, 0};
      params["second"] = Numbers{0, 12};
    }
    const Repeats repeats = run_with_labels(side_by_side(true), halves(), params).get<Features>("features")->repeats();
    const PartPhases phases(repeats, two_parts, 0, {two_parts});
    // Corners of tiles: (16, 12) on the left, (141, 7) on the right.
    const Vector2d at = phases.shown_at(16, 12);
    CHECK(phases.penalty(141, 7, at.x(), at.y()) == 1);
    CHECK(phases.penalty(144, 7, at.x(), at.y()) > 2);
    CHECK(phases.penalty(141, 12, at.x(), at.y()) > 2);
  }
}

TEST_CASE("exemplars of one surface that seem to repeat differently have one lattice if they are said to be alike") {
  const FeaturesPtr boards =
      features_of(two_parts, [](int x, int y) { return y % (x < 130 ? 30 : 20) < 3 ? 1.f : 0.f; });
  const auto run = [&](bool alike) { return run_with_labels(boards, halves(), {{"alike", alike}}); };
  const auto says_unlike = [](const NodeRun& r) {
    return r.notes.front().find("they repeat differently") != std::string::npos;
  };
  CHECK(says_unlike(run(false)));
  const NodeRun alike = run(true);
  CHECK_FALSE(says_unlike(alike));
  const Repeats repeats = alike.get<Features>("features")->repeats();
  CHECK(repeats.parts[0].lattice.rank == 1);
  CHECK(repeats.parts[1].lattice == repeats.parts[0].lattice);
}

TEST_CASE("labels must be rectangles of the features' size") {
  const FeaturesPtr features = side_by_side(true);
  const auto refused = [&](const ImagePtr& labels, const char* message) {
    CHECK_THROWS_WITH_AS(run_with_labels(features, labels), doctest::Contains(message), Error);
  };
  refused(labels_of([](int, int) { return 0.f; }, {20, 20}),
          "expected the size of the exemplar in \"features\", 260x96, found 20x20");
  refused(labels_of([](int x, int y) { return float(x > y); }), "each a rectangle");
  refused(labels_of([](int x, int) { return x == 20 ? std::numeric_limits<float>::quiet_NaN() : 0.f; }),
          "not a number");
  refused(labels_of([](int x, int y) { return float(x + 260 * y); }), "at most 255 exemplars side by side");
}

TEST_CASE("a result that wraps holds a whole number of cells, and positions one cell apart are in phase") {
  const Lattice grid{2, {10.3, 0}, {0, 7.9}, 1};
  const LatticePhase phase(grid, 0, {{100, 80}, true, true});
  REQUIRE(phase.active());
  for (const int x : {0, 13, 99}) {
    const Vector2d here = phase.excess(5, 6, x, 20), around = phase.excess(5, 6, x - 100, 20 + 80);
    CHECK(here.x() == doctest::Approx(around.x()));
    CHECK(here.y() == doctest::Approx(around.y()));
  }
  int u = 50, v = 33;
  phase.snap(3, 4, u, v);
  CHECK(phase.penalty(u, v, 3, 4) == 1.0);
}

TEST_CASE("a few tiles in an exemplar that tiles are a lattice") {
  const Lattice l = lattice_of(features_of({96, 96}, tiles(48, 48), true));
  REQUIRE(l.rank == 2);
  CHECK(std::abs(l.first.x() * l.second.y() - l.first.y() * l.second.x()) == doctest::Approx(48 * 48));
  CHECK(repeats_by(l, 48, 0));
  CHECK(repeats_by(l, 0, 48));
}

TEST_CASE("an exemplar that is one tile is a cell, a cut from within a larger tile is not") {
  const Lattice one = lattice_of(features_of({96, 80}, tiles(96, 80), true));
  REQUIRE(one.rank == 2);
  CHECK(repeats_by(one, 96, 0));
  CHECK(repeats_by(one, 0, 80));
  CHECK(std::abs(one.first.x() * one.second.y() - one.first.y() * one.second.x()) == doctest::Approx(96 * 80));
  const auto within = [](int x, int y) { return tiles(500, 500)(x + 100, y + 100); };
  CHECK(lattice_of(features_of({96, 80}, within, false)).rank == 0);
}

TEST_CASE("two boards of an exemplar that tiles are courses, though their grain is finer") {
  const Lattice l = lattice_of(features_of(
      {128, 128},
      [](int x, int y) {
        const double grain = unit_double(random_bits(7, y / 2, x / 40));
        return y % 64 < 3 || (x + y / 64 * 50) % 128 < 3 ? 0.f : float(1 + 0.1 * grain);
      },
      true));
  REQUIRE(l.rank == 1);
  CHECK(l.first.y() == doctest::Approx(64));
}

TEST_CASE("layers of rock are no courses") {
  const Lattice l = lattice_of(features_of(
      {128, 128},
      [](int x, int y) {
        const double layer = unit_double(random_bits(7, y / 3)), grain = unit_double(random_bits(8, y, x / 3));
        return float(0.2 * layer + 0.8 * grain);
      },
      true));
  CHECK(l.rank == 0);
}

TEST_CASE("an exemplar without lines has no cell, though it tiles") {
  const Lattice l = lattice_of(features_of(
      {96, 96},
      [](int x, int y) {
        float value = 0;
        for (int i = 0; i < 60; i++) {
          const uint64_t r = random_bits(9, i);
          int dx = std::abs(int(r % 96) - x), dy = std::abs(int(r / 96 % 96) - y);
          dx = std::min(dx, 96 - dx), dy = std::min(dy, 96 - dy);
          if (dx * dx + dy * dy < 60) value = float(i) / 60;
        }
        return value;
      },
      true));
  CHECK(l.rank == 0);
}

TEST_CASE("a dark border of an exemplar that does not tile is left out if asked for, and said") {
  const FeaturesPtr features = features_of({128, 128}, [](int, int y) { return y < 96 ? 0.05f : 0.f; });
  for (const bool asked : {true, false}) {
    CAPTURE(asked);
    const Params params = asked ? Params{{"borders", "auto"}} : Params{};
    const NodeRun run = run_node("regularity", params, {{"features", {features}}});
    const ImagePtr mask = run.get<Features>("features")->mask();
    REQUIRE((mask != nullptr) == asked);
    CHECK(run.says("32 pixels at the bottom") == asked);
    if (asked) {
      CHECK(mask->pixels()[size_t(95) * 128] == 1);
      CHECK(mask->pixels()[size_t(96) * 128] == 0);
    }
  }
}

TEST_CASE("a foot of a wall with a sharp edge is left out if asked for, and else makes a course") {
  const FeaturesPtr features = features_of(
      {128, 128}, [](int x, int y) { return float((y < 104 ? 0.4 : 0) + unit_double(random_bits(4, x, y))); });
  for (const bool asked : {true, false}) {
    CAPTURE(asked);
    const Params params = asked ? Params{{"borders", "auto"}} : Params{};
    const NodeRun run = run_node("regularity", params, {{"features", {features}}});
    const auto out = run.get<Features>("features");
    CHECK((out->mask() != nullptr) == asked);
    CHECK(out->repeats().lattice.rank == (asked ? 0 : 1));
    CHECK(run.says("a single course: a result repeats it downwards") == !asked);
  }
}
