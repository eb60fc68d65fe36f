#include "core/synthesis/state/lattice_origin.h"

#include <cmath>
#include <set>

#include <doctest/doctest.h>

#include "core/base/hash.h"

using namespace terrazzo;

namespace {

constexpr Size size{120, 90};

/// Kept pixels that show the exemplar, which repeats, from a start on; some of them something else.
ExistingPixels shown_from(const Lattice& lattice, const Vector2d& start, int other_every) {
  ExistingPixels kept;
  for (int y = 0; y < size.height; y++)
    for (int x = 0; x < size.width; x++) {
      // Other cells of the lattice at other places.
      const Vector2d cell = lattice.first * (1 + x / 50) + lattice.second * (2 + y / 40);
      const bool other = (x + y * size.width) % other_every == 0;
      kept.pixels.push_back({uint16_t(std::lround(x - start.x() + cell.x()) + (other ? 11 : 0) + 200),
                             uint16_t(std::lround(y - start.y() + cell.y()) + (other ? 7 : 0) + 200)});
      kept.keep.push_back(x < 60 ? Keep::always : Keep::never);
    }
  return kept;
}

double off(const Lattice& lattice, const Vector2d& a, const Vector2d& b) {
  const Vector2d c = lattice.cells(a - b);
  return lattice.at({c.x() - std::floor(c.x() + 0.5), c.y() - std::floor(c.y() + 0.5)}).norm();
}

}  // namespace

TEST_CASE("a lattice starts elsewhere with other random bits, at whole pixels") {
  const Lattice cells{2, {30, 0}, {15, 20}, 1};
  std::set<std::pair<double, double>> starts;
  for (uint64_t seed = 1; seed <= 20; seed++) {
    const uint64_t bits = random_bits(seed, 1);
    const Vector2d at = random_lattice_origin(cells, bits);
    CHECK(at.x() == std::floor(at.x()));
    CHECK(at.y() == std::floor(at.y()));
    starts.insert({at.x(), at.y()});
    CHECK(at == random_lattice_origin(cells, bits));
  }
  CHECK(starts.size() > 15);
  CHECK(random_lattice_origin({}, 3) == Vector2d{});
}

TEST_CASE("what is kept tells where its lattice starts") {
  const Lattice cells{2, {30.5, 0}, {15.25, 20}, 1}, whole{2, {30, 0}, {15, 20}, 1}, courses{1, {0, 24.3}, {}, 1};
  const Vector2d offset{200, 200};
  for (const Vector2d& start : {Vector2d{0, 0}, Vector2d{13, 7}, Vector2d{-40, 19}}) {
    CHECK(off(cells, lattice_origin(cells, shown_from(cells, start, 5), size), start - offset) < 0.6);
    CHECK(off(whole, lattice_origin(whole, shown_from(whole, start, 3), size), start - offset) < 1e-6);
    const Vector2d found = lattice_origin(courses, shown_from(courses, start, 5), size);
    CHECK(found.x() == 0);
    CHECK(off(courses, found, start - offset) < 0.6);
  }
}
