#include "core/numeric/screened_poisson.h"

#include <algorithm>
#include <utility>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "core/base/geometry.h"
#include "core/base/portable_math.h"

namespace terrazzo {

namespace {

constexpr int sweeps = 3;  ///< smoothing sweeps before and after the coarser levels
constexpr int cells_a_task = 1 << 14;
constexpr int rows_a_band = 64;

template <typename Body>
void for_rows(int rows, int columns, const Body& body) {
  tbb::parallel_for(tbb::blocked_range<int>(0, rows, std::max(1, cells_a_task / columns)),
                    [&](const tbb::blocked_range<int>& range) {
                      for (int y = range.begin(); y < range.end(); y++) body(y);
                    });
}

/// The residual of a cell's equation, and the equation's diagonal element.
struct Balance {
  float residual, diagonal;
};

inline Balance balance(const CellRow& r, int x) {
  const float left = r.height * r.links[x], right = r.height * r.links[x + 1];
  const float above = r.widths[x] * r.link_above, below = r.widths[x] * r.link_below;
  const float own = r.widths[x] * r.height * r.screen + r.holds[x], v = r.here[x];
  const float flow = (left * (v - r.here[x - 1]) + right * (v - r.here[x + 1])) +
                     (above * (v - r.above[x]) + below * (v - r.below[x]));
  return {r.forces[x] - (flow + own * v), ((left + right) + (above + below)) + own};
}

}  // namespace

CellAxis CellAxis::of_pixels(int count, bool wraps) {
  CellAxis axis{wraps, std::vector<float>(size_t(count), 1.0f), std::vector<float>(size_t(count) + 1, 1.0f)};
  // A single pixel that wraps is its own neighbour: no link.
  if (!wraps || count == 1) axis.links.front() = axis.links.back() = 0;
  return axis;
}

CellAxis CellAxis::coarser() const {
  const size_t n = widths.size(), half = (n + 1) / 2;
  CellAxis out{wraps, std::vector<float>(half), std::vector<float>(half + 1, 0.0f)};
  for (size_t i = 0; i < n; i++) out.widths[i / 2] += widths[i];
  for (size_t i = 1; i < half; i++) out.links[i] = 2 / (out.widths[i - 1] + out.widths[i]);
  if (wraps && half > 1) out.links.front() = out.links.back() = 2 / (out.widths.back() + out.widths.front());
  return out;
}

std::vector<CoarseShare> coarse_shares(const CellAxis& fine, const CellAxis& coarse) {
  std::vector<CoarseShare> shares;
  const int last = coarse.count() - 1;
  for (int i = 0; i < fine.count(); i++) {
    const int near = i / 2;
    const bool alone = i % 2 == 0 && i + 1 == fine.count();
    if (alone) {
      shares.push_back({near, near, 0});
      continue;
    }
    const int next = i % 2 == 0 ? near - 1 : near + 1;
    const int far = coarse.wraps ? wrap(next, last + 1) : std::clamp(next, 0, last);
    // The centre of a pair is half the other cell's width away from this cell's centre.
    const float off = fine.widths[size_t(i ^ 1)] / 2, link = coarse.links[size_t(i % 2 == 0 ? near : near + 1)];
    shares.push_back({near, far, off * link});
  }
  return shares;
}

void residuals(const CellRow& row, float* out) {
  for (int x = 0; x < row.count; x++) out[x] = balance(row, x).residual;
}

void relaxed(const CellRow& row, float step, float* out) {
  for (int x = 0; x < row.count; x++) {
    const Balance b = balance(row, x);
    out[x] = row.here[x] + step * b.residual / b.diagonal;
  }
}

std::vector<float> smoothing_steps(int count) {
  std::vector<float> steps(size_t(count), 0.0f);
  for (int i = 0; i < count; i++)
    steps[size_t(i)] = float(1 / (1.25 + 0.75 * portable::cos_turns((2 * i + 1) / (4.0 * count))));
  return steps;
}

ScreenedPoisson::ScreenedPoisson(CellAxis x, CellAxis y, double screen)
    : screen_(float(screen)), steps_(smoothing_steps(sweeps)) {
  for (;;) {
    Level level;
    level.x = std::move(x);
    level.y = std::move(y);
    const size_t columns = level.x.widths.size(), rows = level.y.widths.size();
    level.forces.resize(columns * rows);
    level.holds.resize(columns);
    level.values.resize(level.stride() * rows);
    x = level.x.coarser();
    y = level.y.coarser();
    level.x_shares = coarse_shares(level.x, x);
    level.y_shares = coarse_shares(level.y, y);
    levels_.push_back(std::move(level));
    if (columns == 1 && rows == 1) return;
  }
}

void ScreenedPoisson::hold(std::vector<float> holds) {
  levels_.front().holds = std::move(holds);
  for (size_t l = 1; l < levels_.size(); l++) {
    const Level& fine = levels_[l - 1];
    Level& coarse = levels_[l];
    const size_t columns = fine.x.widths.size(), half = coarse.x.widths.size();
    coarse.holds.assign(half * coarse.y.widths.size(), 0.0f);
    for (size_t i = 0; i < fine.holds.size(); i++)
      coarse.holds[i / columns / 2 * half + i % columns / 2] += fine.holds[i];
  }
}

float* ScreenedPoisson::forces(int row) {
  Level& level = levels_.front();
  return &level.forces[size_t(row) * level.x.widths.size()];
}

CellRow ScreenedPoisson::Level::cells(int at, float screen) const {
  const int rows = y.count();
  return {.count = x.count(),
          .widths = x.widths.data(),
          .links = x.links.data(),
          .height = y.widths[size_t(at)],
          .link_above = y.links[size_t(at)],
          .link_below = y.links[size_t(at) + 1],
          .above = row(wrap(at - 1, rows)),
          .here = row(at),
          .below = row(wrap(at + 1, rows)),
          .forces = &forces[size_t(at) * x.widths.size()],
          .holds = holds.size() > x.widths.size() ? &holds[size_t(at) * x.widths.size()] : holds.data(),
          .screen = screen};
}

/// Fills the cells before a row's first and after its last.
void ScreenedPoisson::Level::close(float* row) const {
  const int n = x.count();
  row[-1] = row[n - 1];
  row[n] = row[0];
}

void ScreenedPoisson::smooth(Level& level, const Task& task) const {
  for (const float step : steps_) {
    task.check();
    smooth_once(level, step);
  }
}

/// Works in place: each band of rows keeps only those old values that later rows still read.
void ScreenedPoisson::smooth_once(Level& level, float step) const {
  const int rows = level.y.count(), bands = (rows + rows_a_band - 1) / rows_a_band;
  const size_t stride = level.stride();
  std::vector<float> around(size_t(bands) * 2 * stride);  // the row above each band, and the row below
  const auto copy = [&](int y, float* out) { std::copy_n(level.row(y) - 1, stride, out); };
  for (int i = 0; i < bands; i++) {
    copy(wrap(i * rows_a_band - 1, rows), &around[size_t(i) * 2 * stride]);
    copy(std::min((i + 1) * rows_a_band, rows) % rows, &around[(size_t(i) * 2 + 1) * stride]);
  }
  tbb::parallel_for(0, bands, [&](int i) {
    const int first = i * rows_a_band, last = std::min(first + rows_a_band, rows) - 1;
    const float* upper = &around[size_t(i) * 2 * stride];
    std::vector<float> above(upper, upper + stride), here(stride);
    for (int y = first; y <= last; y++) {
      copy(y, here.data());
      CellRow cells = level.cells(y, screen_);
      cells.above = &above[1];
      cells.here = &here[1];
      if (y == last) cells.below = &around[(size_t(i) * 2 + 1) * stride + 1];
      relaxed(cells, step, level.row(y));
      level.close(level.row(y));
      std::swap(above, here);
    }
  });
}

void ScreenedPoisson::restrict_from(const Level& fine, Level& coarse) const {
  const int columns = fine.x.count(), rows = fine.y.count(), half = coarse.x.count();
  for_rows(coarse.y.count(), columns * 2, [&](int y) {
    std::vector<float> upper(size_t(columns), 0.0f), lower = upper;
    residuals(fine.cells(2 * y, screen_), upper.data());
    if (2 * y + 1 < rows) residuals(fine.cells(2 * y + 1, screen_), lower.data());
    for (size_t x = 0; x < upper.size(); x++) upper[x] += lower[x];
    float* out = &coarse.forces[size_t(y) * size_t(half)];
    for (int x = 0; x < half; x++)
      out[x] = upper[2 * size_t(x)] + (2 * x + 1 < columns ? upper[2 * size_t(x) + 1] : 0.0f);
  });
}

void ScreenedPoisson::prolong_to(Level& fine, const Level& coarse) const {
  for_rows(fine.y.count(), fine.x.count(), [&](int y) {
    const CoarseShare& v = fine.y_shares[size_t(y)];
    const float *near = coarse.row(v.near), *far = coarse.row(v.far);
    float* out = fine.row(y);
    const auto along = [&](int x) { return near[x] + v.far_share * (far[x] - near[x]); };
    for (int x = 0; x < fine.x.count(); x++) {
      const CoarseShare& h = fine.x_shares[size_t(x)];
      const float value = along(h.near);
      out[x] += value + h.far_share * (along(h.far) - value);
    }
    fine.close(out);
  });
}

void ScreenedPoisson::cycle(size_t at, const Task& task) {
  Level& level = levels_[at];
  smooth(level, task);
  if (at + 1 == levels_.size()) return;
  Level& next = levels_[at + 1];
  restrict_from(level, next);
  std::fill(next.values.begin(), next.values.end(), 0.0f);
  cycle(at + 1, task);
  prolong_to(level, next);
  smooth(level, task);
}

void ScreenedPoisson::improve(const Task& task) {
  cycle(0, task);
  Level& level = levels_.front();
  for_rows(level.y.count(), level.x.count(), [&](int y) {
    std::vector<float> left_over(level.x.widths.size());
    residuals(level.cells(y, screen_), left_over.data());
    float* row = forces(y);
    for (size_t x = 0; x < left_over.size(); x++) row[x] -= left_over[x];
  });
}

void ScreenedPoisson::finish() {
  levels_.resize(1);
  levels_.front().forces = {};
  levels_.front().holds = {};
}

}  // namespace terrazzo
