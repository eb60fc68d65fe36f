#include "core/analysis/repeats/regularity.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <doctest/doctest.h>

#include "core/procedural/pattern.h"
#include "tests/exemplars.h"
#include "tests/lattices.h"
#include "tests/overrides.h"

using namespace terrazzo;
using namespace terrazzo::test;

namespace {

struct Piece {
  int column, row;  ///< which it is
  double edge;      ///< how far inside it a point lies, in units of the pattern
};

/// A point of a pattern, in its units.
using Pattern = Piece (*)(double x, double y);

double inside(double x, double y, double width, double height) {
  return std::min(std::min(x, width - x), std::min(y, height - y));
}

double part(double v) {
  return v - std::floor(v);
}

Piece running_bond(double x, double y) {
  const double row = std::floor(y * 2.5), shift = wrap(int(row), 2) * 0.5;
  return {int(std::floor(x - shift)) * 2 + wrap(int(row), 2), int(row),
          inside(part(x - shift), part(y * 2.5) / 2.5, 1, 0.4)};
}

/// A course of stretchers, a course of headers.
Piece english_bond(double x, double y) {
  const int row = int(std::floor(y * 3));
  const double width = row & 1 ? 0.5 : 1, shift = row & 1 ? 0.25 : 0;
  const double place = (x - shift) / width;
  return {int(std::floor(place)) * 2 + (row & 1), row, inside(part(place) * width, part(y * 3) / 3, width, 1.0 / 3)};
}

/// Squares of two bricks, lying and standing in turn.
Piece basket_weave(double x, double y) {
  const int column = int(std::floor(x)), row = int(std::floor(y));
  const bool stands = (column + row) & 1;
  const double across = stands ? part(x) : part(y), along = stands ? part(y) : part(x);
  return {column * 2 + (across > 0.5), row, inside(along, part(across * 2) / 2, 1, 0.5)};
}

/// Blocks of three to one, in zigzag.
Piece herringbone(double x, double y) {
  const double u = (x + y) / std::sqrt(2.0), v = (y - x) / std::sqrt(2.0);
  const int column = int(std::floor(u)), row = int(std::floor(v)), kind = wrap(column - row, 6);
  if (kind < 3) return {column - kind, row, inside(u - (column - kind), part(v), 3, 1)};
  const int first = row - (5 - kind);
  return {column, first + 1000, inside(part(u), v - first, 1, 3)};
}

Piece squares(double x, double y) {
  return {int(std::floor(x)), int(std::floor(y)), inside(part(x), part(y), 1, 1)};
}

/// A picture of a pattern from (x, y) on, `unit` pixels to its unit. Pieces differ in shade; joints are light.
FeaturesPtr picture(Pattern pattern, double unit, double x, double y, double joint = 2, int side = 192) {
  return plain_features(make_image({side, side}, 1, [&](int i, int j, int) {
    const Piece p = pattern((i + 0.5) / unit + x, (j + 0.5) / unit + y);
    const double shade = 0.4 * unit_double(random_bits(5, p.column, p.row));
    const double piece = std::clamp(p.edge * unit - joint + 0.5, 0.0, 1.0);
    return float(0.9 + piece * (shade - 0.9) + 0.1 * unit_double(random_bits(6, i, j)));
  }));
}

/// Boards that rise by `slope` in every second column and fall in the others, `height` pixels high where they are cut.
/// They differ in shade more than joints do.
FeaturesPtr chevron(double width, double slope, double height) {
  return plain_features(make_image({256, 256}, 1, [&](int i, int j, int) {
    const double x = (i + 0.5) / width, along = part(x) * width;
    const int column = int(std::floor(x));
    const double y = (j + 0.5 + slope * (column % 2 ? width - along : along)) / height;
    const double across = std::min(part(y), 1 - part(y)) * height / std::sqrt(1 + slope * slope);
    const double shade = 0.3 + 0.5 * unit_double(random_bits(5, column, int(std::floor(y))));
    const bool joint = std::min({across, along, width - along}) < 1;
    return float((joint ? 0.1 : shade) + 0.05 * unit_double(random_bits(6, i, j)));
  }));
}

/// Whether all of the lattice's steps are whole ones of the lattice of (ax, ay) and (bx, by), and at most `cells` of
/// its cells make one.
void check_cell(const Lattice& l, double ax, double ay, double bx, double by, double cells = 1) {
  CAPTURE(l.first.x());
  CAPTURE(l.first.y());
  CAPTURE(l.second.x());
  CAPTURE(l.second.y());
  CAPTURE(l.certainty);
  REQUIRE(l.rank == 2);
  const Lattice truth{2, {ax, ay}, {bx, by}, 1};
  CHECK(repeats_by(truth, l.first.x(), l.first.y()));
  CHECK(repeats_by(truth, l.second.x(), l.second.y()));
  const double area = std::abs(l.first.x() * l.second.y() - l.first.y() * l.second.x()) / std::abs(ax * by - ay * bx);
  CHECK(area < cells + 0.1);
  CHECK(area > 0.9);
}

Lattice lattice_of(const FeaturesPtr& features) {
  return find_lattice(*features, 0.08, Task()).lattice;
}

}  // namespace

TEST_CASE("the half bricks of a basket weave lie on a grid, but its squares are the cells") {
  for (const double unit : {28.0, 43.0, 60.0}) {
    CAPTURE(unit);
    check_cell(lattice_of(picture(basket_weave, unit, 0.3, 0.6)), unit, unit, 2 * unit, 0);
  }
}

TEST_CASE("courses of stretchers and of headers are not taken for one another") {
  for (const double unit : {34.0, 52.0, 77.0}) {
    CAPTURE(unit);
    check_cell(lattice_of(picture(english_bond, unit, 0.1, 0.2)), unit, 0, 0, unit * 2 / 3);
  }
}

TEST_CASE("a herringbone in zigzag repeats with its blocks' ends, not with their sides") {
  for (const double unit : {12.0, 17.0, 23.0}) {
    CAPTURE(unit);
    const double step = unit * std::sqrt(2.0);
    check_cell(lattice_of(picture(herringbone, unit, 0.4, 0.7)), 0, step, 3 * step, 0);
  }
}

TEST_CASE("columns of a chevron floor come again after the one that mirrors them") {
  for (const double width : {24.0, 40.0, 60.0})
    for (const double slope : {0.5, 0.8, 1.0, 1.2})
      for (const double boards : {2.0, 3.3}) {
        CAPTURE(width);
        CAPTURE(slope);
        CAPTURE(boards);
        const Lattice found = lattice_of(chevron(width, slope, width / boards));
        CAPTURE(found.first.x());
        CAPTURE(found.first.y());
        REQUIRE(found.rank > 0);
        const Lattice truth{2, {2 * width, 0}, {0, width / boards}, 1};
        CHECK(repeats_by(truth, found.first.x(), found.first.y()));
        if (found.rank == 2) CHECK(repeats_by(truth, found.second.x(), found.second.y()));
      }
}

TEST_CASE("of few bricks, whole ones are found and not halves") {
  for (const double unit : {60.0, 90.0, 110.0}) {
    CAPTURE(unit);
    check_cell(lattice_of(picture(running_bond, unit, 0.35, 0.1)), unit, 0, unit / 2, unit * 0.4);
  }
}

/// Blocks of which each has a shade of its own, with a grain louder than what joints differ from them.
FeaturesPtr grainy_blocks(int seed, bool of_all_widths) {
  return plain_features(make_image({256, 256}, 1, [&](int x, int y, int) {
    const int row = (y + 17) / 48, start = row & 1 ? 9 : 57;
    int column = (x + start) / 96, left = column * 96 - start;
    if (of_all_widths)
      for (column = 0, left = -int(below(uint32_t(random_bits(8, row, seed)), 96));; column++) {
        const int width = 48 + int(below(uint32_t(random_bits(9, row, column, seed)), 96));
        if (x < left + width) break;
        left += width;
      }
    const bool joint = (y + 17) % 48 < 3 || x - left < 3;
    const double shade = 0.4 + 0.1 * unit_double(random_bits(5, column, row, seed));
    return float(joint ? 0.62 : shade + 0.5 * (unit_double(random_bits(6, x, y, seed)) - 0.5));
  }));
}

TEST_CASE("blocks in a bond are told from blocks of all widths by joints fainter than their grain") {
  for (int seed = 0; seed < 5; seed++) {
    CAPTURE(seed);
    const Lattice bond = lattice_of(grainy_blocks(seed, false));
    check_cell(bond, 96, 0, 48, 48);
    // Who asks for more than its certainty gets no bond.
    CHECK(find_lattice(*grainy_blocks(seed, false), bond.certainty + 0.01, Task()).lattice.rank < 2);
    const Lattice courses = lattice_of(grainy_blocks(seed, true));
    CHECK(courses.rank == 1);
    CHECK(courses.first.y() == doctest::Approx(48).epsilon(0.02));
  }
}

TEST_CASE("boards of all lengths have no bond, however few they are") {
  for (uint64_t seed = 1; seed <= 4; seed++) {
    CAPTURE(seed);
    const PatternSpec spec{.type = "planks", .size = {256, 256}, .seed = seed, .tileable = false};
    const ImagePtr boards = make_pattern(spec, Task())->find("base_color");
    CHECK(lattice_of(plain_features(boards)).rank == 1);
  }
}

TEST_CASE("tiles of which an exemplar that does not tile shows hardly two are found") {
  check_cell(lattice_of(picture(squares, 105, 0.35, 0.45, 3)), 105, 0, 0, 105);
}

TEST_CASE("worn tiles aslant whose colours and joints tell the same cells are found, though either alone is faint") {
  const auto floor = [](bool tiled) {
    return plain_features(make_image({256, 256}, 1, [tiled](int i, int j, int) {
      const double u = (i + j) / 91.0, v = (j - i) / 91.0;
      const double shade = 0.3 * unit_double(random_bits(5, int(std::floor(u)), int(std::floor(v)) + 100));
      double grain = 0;
      for (int k = 0; k < 9; k++) grain += unit_double(random_bits(6, (i + k % 3) / 2, (j + k / 3) / 2)) / 9;
      const bool joint = tiled && inside(part(u), part(v), 1, 1) * 91 / std::sqrt(2.0) < 1.5;
      return float((joint ? 0.35 : 0.5 + (tiled ? shade : 0)) + grain);
    }));
  };
  const Lattice found = find_lattice(*floor(true), 0.08, Task()).lattice;
  REQUIRE(found.rank == 2);
  CHECK(repeats_by(found, 45.5, 45.5));
  CHECK(repeats_by(found, -45.5, 45.5));
  CHECK(find_lattice(*floor(false), 0.08, Task()).lattice.rank == 0);
  const TuningOverride alone("regularity.told_twice", 1);
  CHECK(find_lattice(*floor(true), 0.08, Task()).lattice.rank == 0);
}

TEST_CASE("fine cells are not taken for large ones that fall on whole pixels") {
  const double unit = 9.4;
  check_cell(lattice_of(picture(squares, unit, 0.3, 0.6, 1)), unit, 0, 0, unit);
}

TEST_CASE("cells of a few pixels come two by two") {
  const double unit = 6.4;
  const Lattice l = lattice_of(picture(squares, unit, 0.3, 0.6, 1));
  check_cell(l, unit, 0, 0, unit, 4);
  CHECK(repeats_by(l, 2 * unit, 0));
  CHECK(!repeats_by(l, unit, 0));
}

TEST_CASE("a chequered floor repeats with its colours, not with its joints") {
  const auto chequered = [](int x, int y) {
    const bool joint = x % 24 == 0 || y % 24 == 0;
    return float(joint ? 0.5 : (x / 24 + y / 24) % 2 + 0.3 * unit_double(random_bits(4, x / 24, y / 24)));
  };
  const Lattice l = lattice_of(
      plain_features(make_image({180, 200}, 1, [&](int x, int y, int) { return chequered(x + 11, y + 7); })));
  check_cell(l, 24, 24, 48, 0);
}

TEST_CASE("a drawn chequered floor repeats by whole pixels, to the bit") {
  for (const int side : {23, 32}) {
    CAPTURE(side);
    const Lattice l = lattice_of(plain_features(
        make_image({256, 256}, 1, [&](int x, int y, int) { return (x / side + y / side) % 2 == 0 ? 0.2f : 0.8f; })));
    REQUIRE(l.rank == 2);
    for (const Vector2d& v : {l.first, l.second}) {
      CHECK(std::abs(v.x()) == side);
      CHECK(std::abs(v.y()) == side);
    }
  }
}

TEST_CASE("four parts of a texture that are half alike are no cells, though it tiles") {
  const auto ground = [](double alike) {
    return plain_features(make_image({128, 128}, 1,
                                     [=](int x, int y, int) {
                                       const auto spot = [&](int kind, int u, int v) {
                                         return unit_double(random_bits(kind, u / 4, v / 4));
                                       };
                                       return float(alike * spot(1, x % 64, y % 64) + (1 - alike) * spot(2, x, y));
                                     }),
                          true);
  };
  CHECK(lattice_of(ground(0.5)).rank < 2);
  check_cell(lattice_of(ground(0.8)), 64, 0, 0, 64);
}

TEST_CASE("a herringbone that tiles and comes four times is found") {
  const double side = 192, step = side / 6;
  const FeaturesPtr f = plain_features(make_image({int(side), int(side)}, 1,
                                                  [&](int i, int j, int) {
                                                    const double unit = step / std::sqrt(2.0);
                                                    const Piece p = herringbone((i + 0.5) / unit, (j + 0.5) / unit);
                                                    const double shade = 0.4 * unit_double(random_bits(5, p.column));
                                                    return float(p.edge * unit < 2 ? 0.9 : shade);
                                                  }),
                                       true);
  check_cell(lattice_of(f), 0, step, 3 * step, 0);
}

TEST_CASE(
    "stripes aslant of an exemplar that tiles are followed, whole or worn; what fades and grain of one direction are "
    "not") {
  // Steps of `across` pixels along x after which stripes come again, of `down` along y.
  const auto stripes = [](Size size, int across, int down, double clear) {
    return plain_features(make_image(size, 1,
                                     [=](int x, int y, int) {
                                       const bool light = part(double(x) / across + double(y) / down) < 0.45;
                                       const double grain = unit_double(random_bits(4, x / 2, y / 2));
                                       return float(clear * (light ? 1 : 0) + 0.6 * grain);
                                     }),
                          true);
  };
  for (const auto& [across, down] : {std::pair{32, 32}, {64, -32}, {-32, 128}}) {
    CAPTURE(across);
    CAPTURE(down);
    for (const double clear : {1.0, 0.5}) {
      CAPTURE(clear);
      const Lattice l = lattice_of(stripes({256, 256}, across, down, clear));
      REQUIRE(l.rank == 2);
      CHECK(l.certainty > 0.6);
      for (const Vector2d& v : {l.first, l.second}) {
        const double steps = v.x() / across + v.y() / down;
        CHECK(steps == doctest::Approx(std::floor(steps + 0.5)).epsilon(0.02));
      }
    }
  }
  CHECK(lattice_of(stripes({256, 256}, 32, 32, 0)).rank == 0);
  const auto slanted_grain = [](int x, int y, int) {
    return float(unit_double(random_bits(4, wrap(x + y, 256) / 3)) + unit_double(random_bits(5, x / 2, y / 2)));
  };
  CHECK(lattice_of(plain_features(make_image({256, 256}, 1, slanted_grain), true)).rank == 0);
}

TEST_CASE("joints that cross without a second tile to measure are told of, stones are not") {
  CHECK(find_lattice(*picture(squares, 170, 0.35, 0.45, 3), 0.08, Task()).too_few);
  CHECK(!find_lattice(*picture(squares, 40, 0.35, 0.45, 3), 0.08, Task()).too_few);
  const FeaturesPtr stones = plain_features(make_image({160, 160}, 1, [](int x, int y, int) {
    double nearest = 1e9, shade = 0;
    for (int i = 0; i < 60; i++) {
      const uint64_t r = random_bits(9, i);
      const double dx = double(r % 160) - x, dy = double(r / 160 % 160) - y;
      if (dx * dx + dy * dy < nearest) {
        nearest = dx * dx + dy * dy;
        shade = i / 60.0;
      }
    }
    return float(shade);
  }));
  const FoundLattice none = find_lattice(*stones, 0.08, Task());
  CHECK(none.lattice.rank == 0);
  CHECK(!none.too_few);
}

TEST_CASE("an exemplar of half the size has a lattice half as large") {
  for (const PatternType& type : pattern_types()) {
    CAPTURE(type.name);
    const ImagePtr large = make_pattern({.type = type.name, .size = {512, 512}}, Task())->find("base_color");
    const std::vector<float> pixels = large->pixels();
    const ImagePtr small = make_image({256, 256}, 3, [&](int x, int y, int c) {
      const auto row = [&](int j) { return &pixels[(size_t(2 * y + j) * 512 + 2 * x) * 3 + c]; };
      return (row(0)[0] + row(0)[3] + row(1)[0] + row(1)[3]) / 4;
    });
    const Lattice a = lattice_of(plain_features(large, true)), b = lattice_of(plain_features(small, true));
    REQUIRE(a.rank == b.rank);
    for (Vector2d Lattice::*v : {&Lattice::first, &Lattice::second}) {
      CHECK(std::abs((a.*v).x() - 2 * (b.*v).x()) < 0.5);
      CHECK(std::abs((a.*v).y() - 2 * (b.*v).y()) < 0.5);
    }
  }
}

TEST_CASE("long narrow strips hold no lattice that could be seen") {
  for (const Size strip : {Size{16, 2048}, Size{2048, 16}, Size{1024, 20}})
    for (const bool wraps : {false, true}) {
      CAPTURE(strip.width);
      CAPTURE(wraps);
      const FeaturesPtr noise = plain_features(
          make_image(strip, 1, [](int i, int j, int) { return float(unit_double(random_bits(6, i, j))); }), wraps);
      CHECK(lattice_of(noise).rank == 0);
    }
}

TEST_CASE("of a masked exemplar the part that may be seen tells how it repeats") {
  const auto masked = [](Pattern pattern, auto allowed) {
    const FeaturesPtr all = picture(pattern, 24, 0.3, 0.4);
    return Features::make(all->size(), all->images(), false, {},
                          make_image({192, 192}, 1, [&](int x, int y, int) { return allowed(x, y) ? 1.f : 0.f; }));
  };
  const auto band = [](int, int y) { return y >= 50 && y < 130; };
  const auto corner = [](int x, int y) { return x < 110 && y < 120; };
  const auto around = [](int x, int y) { return (x - 90) * (x - 90) + (y - 80) * (y - 80) > 45 * 45; };
  check_cell(lattice_of(masked(squares, band)), 24, 0, 0, 24);
  check_cell(lattice_of(masked(squares, corner)), 24, 0, 0, 24);
  check_cell(lattice_of(masked(squares, around)), 24, 0, 0, 24, 2);
  check_cell(lattice_of(masked(running_bond, corner)), 24, 0, 12, 9.6, 2);
  check_cell(lattice_of(masked(running_bond, around)), 24, 0, 12, 9.6, 2);
  // Of too little nothing is told.
  CHECK(lattice_of(masked(squares, [](int x, int) { return x < 12; })).rank == 0);
}
