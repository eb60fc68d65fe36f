#include "core/analysis/repeats/part_lattices.h"

#include <cmath>
#include <functional>

#include <doctest/doctest.h>

#include "core/analysis/repeats/cell_phase.h"
#include "core/base/hash.h"

using namespace terrazzo;

namespace {

using Picture = std::function<float(double, double)>;

/// Light joints between tiles of 24x16 pixels whose upper left corners are a little darker, with some grain.
float tiles(double x, double y) {
  const double u = x - 24 * std::floor(x / 24), v = y - 16 * std::floor(y / 16);
  return u < 2 || v < 2 ? 0.9f : u < 10 && v < 8 ? 0.3f : 0.45f;
}

/// What a part at `place` of a larger exemplar shows.
ExemplarView view(const Rect& place, const Picture& picture) {
  Planes planes{{place.width, place.height}, 1, false, {}};
  for (int y = 0; y < place.height; y++)
    for (int x = 0; x < place.width; x++)
      planes.values.push_back(picture(x, y) + 0.1f * float(unit_double(random_bits(4, place.x + x, y))));
  ExemplarView v = view_of(planes, {}, whole(planes.size));
  v.seen.x += place.x;
  v.seen.y += place.y;
  return v;
}

Picture moved(const Picture& picture, double dx, double dy) {
  return [=](double x, double y) { return picture(x - dx, y - dy); };
}

double part_of(double v) {
  return v - std::floor(v + 0.5);
}

/// By how much, in pixels along x and y, two positions are apart but for whole steps of a rectangular cell.
Vector2d apart(const Vector2d& a, const Vector2d& b, const Vector2d& cell) {
  return {std::abs(part_of((a.x() - b.x()) / cell.x())) * cell.x(),
          std::abs(part_of((a.y() - b.y()) / cell.y())) * cell.y()};
}

const Lattice grid{2, {24, 0}, {0, 16}, 0.8};
std::vector<LatticePart> together(const std::vector<ExemplarPart>& parts, size_t kinds = 1) {
  BroughtTogether all = brought_together(parts, Task());
  CHECK(all.kinds == kinds);
  return std::move(all.parts);
}

constexpr Rect left{0, 0, 120, 96}, right{130, 0, 120, 96};

}  // namespace

TEST_CASE("the phase between two views of the same cells is found, whatever their brightness") {
  for (const bool negative : {false, true}) {
    const Picture other = [&](double x, double y) {
      const float v = tiles(x - 7, y - 5.5);
      return v < 0.8f && negative ? v + 0.4f : v;
    };
    const ExemplarView a = view(left, tiles), b = view({0, 0, 110, 90}, other);
    const Vector2d cells = phase_between({a, grid}, {b, grid}, Task());
    CAPTURE(negative);
    CHECK(std::abs(part_of(cells.x() - 7.0 / 24)) * 24 < 0.6);
    CHECK(std::abs(part_of(cells.y() - 5.5 / 16)) * 16 < 0.6);
  }
}

TEST_CASE("pixels that a mask leaves out do not count for the phase") {
  Planes planes{{120, 96}, 1, false, {}};
  std::vector<uint8_t> allowed;
  for (int y = 0; y < 96; y++)
    for (int x = 0; x < 120; x++) {
      const bool seen = x < 30 || y > 60;
      planes.values.push_back(seen ? tiles(x - 3, y) : 5 * tiles(x + 9, y + 7));
      allowed.push_back(seen);
    }
  const Vector2d cells = phase_between({view(left, tiles), grid}, {view_of(planes, allowed, left), grid}, Task());
  CHECK(std::abs(part_of(cells.x() - 3.0 / 24)) * 24 < 0.6);
  CHECK(std::abs(part_of(cells.y())) * 16 < 0.6);
}

TEST_CASE("parts with alike cells are shown as the first, moved so that their joints meet") {
  const Lattice turned{2, {0, -16.05}, {24.1, 16.05}, 0.7};  // the same cells, in other steps and measured a little off
  const std::vector<LatticePart> parts =
      together({{left, view(left, tiles), grid}, {right, view(right, moved(tiles, 7, 5)), turned}});
  REQUIRE(parts.size() == 2);
  CHECK(parts[0].start.x() == 0);
  CHECK(parts[0].shown.first.x() == 24);
  CHECK(parts[1].shown.first.x() == doctest::Approx(24));
  CHECK(parts[1].shown.second.y() == doctest::Approx(16));
  CHECK(parts[1].lattice.first.x() == doctest::Approx(24.1));
  CHECK(parts[1].lattice.certainty == 0.7);
  // A corner of the second part's tiles is at (130 + 7, 5), where the first has one at (0, 0).
  const Vector2d off = apart(parts[1].start, {137, 5}, {24.1, 16.05});
  CHECK(off.x() < 1);
  CHECK(off.y() < 1);
}

TEST_CASE("parts that have only courses in common share these") {
  const Lattice courses{1, {0, 15.8}, {}, 0.5};
  const std::vector<LatticePart> parts =
      together({{left, view(left, tiles), grid}, {right, view(right, moved(tiles, 0, 6)), courses}});
  CHECK(parts[1].lattice.first.y() == 15.8);
  CHECK(parts[1].shown.rank == 1);
  CHECK(parts[1].shown.first.y() == doctest::Approx(16));
  CHECK(apart(parts[1].start, {0, 6}, {1, 15.8}).y() < 1);

  const Lattice wider{2, {37, 0}, {18.5, 16}, 0.5};
  const std::vector<LatticePart> bonds =
      together({{left, view(left, tiles), grid}, {right, view(right, moved(tiles, 0, 6)), wider}});
  CHECK(bonds[1].lattice.first.x() == 37);
  CHECK(bonds[1].shown.first.x() == 37);
  CHECK(bonds[1].start.x() == 0);
  CHECK(apart(bonds[1].start, {0, 6}, {1, 16}).y() < 1);
}

TEST_CASE("a lattice of every second tile is one with that of every tile") {
  const Lattice pairs{2, {48, 0}, {0, 16}, 0.5};
  for (const bool first : {false, true}) {
    const std::vector<LatticePart> parts = together({{left, view(left, tiles), first ? pairs : grid},
                                                     {right, view(right, moved(tiles, 7, 5)), first ? grid : pairs}});
    CHECK(parts[1].lattice.first.x() == doctest::Approx(48));
    CHECK(parts[1].shown.first.x() == doctest::Approx(48));
    CHECK(apart(parts[1].start, {137, 5}, {24, 16}).x() < 1);
  }
}

TEST_CASE("parts that differ more, or do not repeat, keep what they have") {
  const Lattice other{2, {31, 0}, {0, 19}, 0.5};
  const ExemplarView some = view(left, tiles);
  const std::vector<LatticePart> parts = together({{left, some, grid}, {right, some, other}, {left, some, {}}}, 2);
  CHECK(parts[1].shown.first.x() == 31);
  CHECK(parts[1].shown.second.y() == 19);
  CHECK(parts[1].start.x() == 0);
  CHECK(parts[2].lattice.rank == 0);
  CHECK(parts[2].shown.rank == 0);
}
