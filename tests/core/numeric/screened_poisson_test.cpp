#include "core/numeric/screened_poisson.h"

#include <cmath>

#include <doctest/doctest.h>
#include <tbb/task_arena.h>

#include "core/base/geometry.h"
#include "core/base/hash.h"

using namespace terrazzo;

namespace {

struct Problem {
  Size size;
  bool wraps_x, wraps_y;
  double screen;
};

float random_force(int x, int y) {
  return float(random_bits(7, x, y) % 2001) / 1000 - 1;
}

ScreenedPoisson solver(const Problem& p) {
  return {CellAxis::of_pixels(p.size.width, p.wraps_x), CellAxis::of_pixels(p.size.height, p.wraps_y), p.screen};
}

/// What a cell's force lacks, by its value and its neighbours'.
double lack(const Problem& p, const ScreenedPoisson& s, int x, int y) {
  const double v = s.values(y)[x];
  double force = v * p.screen;
  for (const auto& [dx, dy] : {std::pair(1, 0), {-1, 0}, {0, 1}, {0, -1}}) {
    int i = x + dx, j = y + dy;
    if (p.wraps_x) i = wrap(i, p.size.width);
    if (p.wraps_y) j = wrap(j, p.size.height);
    if (i < 0 || j < 0 || i >= p.size.width || j >= p.size.height) continue;
    force += v - double(s.values(j)[i]);
  }
  return random_force(x, y) - force;
}

/// One cycle more; the greatest lack after it.
double improved(const Problem& p, ScreenedPoisson& s) {
  for (int y = 0; y < p.size.height; y++)
    for (int x = 0; x < p.size.width; x++) s.forces(y)[x] += float(lack(p, s, x, y));
  s.improve({});
  double worst = 0;
  for (int y = 0; y < p.size.height; y++)
    for (int x = 0; x < p.size.width; x++) worst = std::max(worst, std::abs(lack(p, s, x, y)));
  return worst;
}

}  // namespace

TEST_CASE("the equation is solved on grids of any size, wrapping or not, with weak and strong screening") {
  for (const Size size : {Size{1, 1}, {1, 2}, {1, 37}, {50, 1}, {2, 2}, {3, 5}, {32, 32}, {61, 23}, {7, 130}})
    for (const bool wraps_x : {false, true})
      for (const bool wraps_y : {false, true})
        for (const double screen : {1.0, 0.01, 1e-4}) {
          const Problem p{size, wraps_x, wraps_y, screen};
          CAPTURE(size.width);
          CAPTURE(size.height);
          CAPTURE(screen);
          ScreenedPoisson s = solver(p);
          double worst = 1;
          for (int i = 0; i < 12; i++) worst = improved(p, s);
          CHECK(worst < 1e-3);
        }
}

TEST_CASE("each cycle leaves less than half of what lacks, however large the grid") {
  for (const int side : {16, 99, 256}) {
    const Problem p{{side, side}, false, true, 1e-3};
    ScreenedPoisson s = solver(p);
    double before = 1;
    for (int i = 0; i < 4; i++) {
      const double after = improved(p, s);
      CHECK(after < 0.5 * before);
      before = after;
    }
  }
}

TEST_CASE("values are the same bits with any number of threads") {
  const auto values = [](int threads) {
    std::vector<float> out;
    tbb::task_arena(threads).execute([&] {
      const Problem p{{203, 301}, true, false, 0.001};
      ScreenedPoisson s = solver(p);
      improved(p, s);
      improved(p, s);
      s.finish();
      for (int y = 0; y < 301; y++) out.insert(out.end(), s.values(y), s.values(y) + 203);
    });
    return out;
  };
  CHECK(values(1) == values(4));
}

TEST_CASE("a coarser axis has the same length, and values that lie on a line are interpolated exactly") {
  for (const int count : {2, 3, 8, 13}) {
    const CellAxis fine = CellAxis::of_pixels(count, false), coarse = fine.coarser(), coarsest = coarse.coarser();
    const auto centres = [](const CellAxis& axis) {
      std::vector<double> out;
      double at = 0;
      for (const float w : axis.widths) {
        out.push_back(at + double(w) / 2);
        at += double(w);
      }
      out.push_back(at);
      return out;
    };
    CHECK(centres(coarse).back() == count);
    const std::vector<double> from = centres(coarsest), to = centres(coarse);
    const std::vector<CoarseShare> shares = coarse_shares(coarse, coarsest);
    for (size_t i = 0; i + 1 < to.size(); i++) {
      const CoarseShare& s = shares[i];
      const double near = from[size_t(s.near)], far = from[size_t(s.far)];
      if (s.near != s.far) CHECK(near + s.far_share * (far - near) == doctest::Approx(to[i]));
    }
  }
}
