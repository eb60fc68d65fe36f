#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/synthesis/correction.cpp"
#include "core/synthesis/correction.h"

#include <hwy/foreach_target.h>
#include <hwy/highway.h>
#include <tbb/parallel_for.h>

#include "core/hash.h"

HWY_BEFORE_NAMESPACE();
namespace terrazzo {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// Corrects single pixels: gathers what surrounds them and picks the best candidate. One per thread and row.
/// `steered`: the exemplar has a mask or the level a control.
template <bool steered>
class PixelCorrector {
 public:
  PixelCorrector(const Field& field, const CorrectionLevel& level, const CorrectionPass& pass,
                 const Occupancy& occupancy)
      : field_(field), level_(level), pass_(pass), occupancy_(occupancy), taps_(int(pass.window->size())) {
    for (int t = 0; t < taps_; t++) {
      const auto [dx, dy] = (*pass.window)[t];
      all_offsets_[t] = dy * level.exemplar.stride() + dx;
    }
  }

  HWY_ATTR ExemplarPixel best(int x, int y) {
    gather(x, y);
    x_ = x;
    y_ = y;
    if constexpr (steered)
      if (level_.control) target_ = level_.control->target(int64_t{y} * field_.size.width + x);
    seen_ = 0;
    best_cost_ = ~uint64_t{0};
    best_ = field_.at(x, y);
    consider(best_.x, best_.y, coherence(around_[0]));
    for (int n = 1; n < 9; n++)
      if (around_[n]) consider(around_[n]->x - step(n, 0), around_[n]->y - step(n, 1), coherence(around_[n]));
    for (int n = 0; n < 9; n++) {
      if (!around_[n]) continue;
      const size_t at = size_t(around_[n]->y) * level_.exemplar.size().width + around_[n]->x;
      const ExemplarPixel* similar = &level_.similar[at * level_.per_pixel];
      for (int k = 0; k < level_.per_pixel; k++)
        consider(similar[k].x - step(n, 0), similar[k].y - step(n, 1), unit_factor);
    }
    for (int k = 0; k < pass_.random_candidates; k++) {
      const uint64_t r = random_bits(pass_.seed, level_.level, pass_.pass, x, y, k);
      auto [u, v] = level_.exemplar.place(r);
      level_.phase.snap(x, y, u, v);
      consider(u, v, unit_factor);
    }
    return best_;
  }

 private:
  /// How many of the pixels a little way off show nearly what the candidate would show here. A piece that comes back
  /// after a few pixels makes combed streaks, a pixel that comes back at once makes waffles.
  uint32_t repeats(int x, int y) const {
    uint32_t count = 0;
    for (int n = 0; n < ring_count_; n++)
      count += 2 * std::abs(ring_[n].x - x) < ring_[n].radius && 2 * std::abs(ring_[n].y - y) < ring_[n].radius;
    return count;
  }

  uint32_t coherence(const ExemplarPixel* continued) const {
    if (pass_.piece_coherence.empty()) return pass_.coherence;
    return pass_.piece_coherence[size_t(continued - field_.pixels.data())];
  }

  static int step(int n, int axis) {
    constexpr int steps[9][2] = {{0, 0}, {-1, 0}, {1, 0}, {0, -1}, {0, 1}, {-1, -1}, {1, -1}, {-1, 1}, {1, 1}};
    return steps[n][axis];
  }

  /// The pixel at an offset; null beyond the border of an output that does not tile.
  const ExemplarPixel* neighbour(int x, int y) const {
    const int64_t i = pixel_index(field_.size, x, y, level_.tile_x, level_.tile_y);
    return i < 0 ? nullptr : &field_.pixels[size_t(i)];
  }

  HWY_ATTR void gather(int x, int y) {
    for (int n = 0; n < 9; n++) around_[n] = neighbour(x + step(n, 0), y + step(n, 1));
    ring_count_ = 0;
    for (const int radius : ring_radii)
      for (int n = 1; n < 9; n++)
        if (const ExemplarPixel* p = neighbour(x + radius * step(n, 0), y + radius * step(n, 1)))
          ring_[ring_count_++] = {p->x, p->y, radius};
    count_ = 0;
    for (int t = 0; t < taps_; t++) {
      const auto [dx, dy] = (*pass_.window)[t];
      const ExemplarPixel* p = neighbour(x + dx, y + dy);
      if (!p) continue;
      copy(*level_.exemplar.at(p->x, p->y), wanted_[count_]);
      offsets_[count_++] = all_offsets_[t];
    }
  }

  HWY_INLINE HWY_ATTR void consider(int x, int y, uint32_t factor) {
    if constexpr (steered) {
      if (!level_.exemplar.settles(x, y)) return;
    } else {
      level_.exemplar.settle_inside(x, y);
    }
    const uint32_t id = uint32_t(y) << 16 | uint32_t(x);
    for (int i = 0; i < seen_; i++)
      if (seen_ids_[i] == id) return;
    seen_ids_[seen_++] = id;
    if (occupancy_.active()) factor = uint32_t((uint64_t{factor} * occupancy_.factor(x, y)) / unit_factor);
    factor += factor / 2 * repeats(x, y);
    if (level_.phase.active()) factor = uint32_t(std::min(most_factor, factor * level_.phase.penalty(x, y, x_, y_)));
    const uint64_t limit = best_cost_ / factor;
    uint64_t off_target = 0;
    if constexpr (steered) {
      if (level_.control) off_target = level_.control->cost(x, y, target_) * uint64_t(count_);
      if (off_target > limit) return;
    }
    const uint64_t cost = (distance(x, y, limit - off_target) + off_target) * factor;
    if (cost < best_cost_) {
      best_cost_ = cost;
      best_ = {uint16_t(x), uint16_t(y)};
    }
  }

#if HWY_TARGET == HWY_SCALAR
  static int tap_distance(const AppearanceVector* wanted, const AppearanceVector* centre, const ptrdiff_t* offsets,
                          int count) {
    int sum = 0;
    for (int t = 0; t < count; t++) sum += squared_distance(wanted[t], centre[offsets[t]]);
    return sum;
  }
  static void copy(const AppearanceVector& from, AppearanceVector& to) {
    to = from;
  }
#else
  HWY_ATTR static int tap_distance(const AppearanceVector* wanted, const AppearanceVector* centre,
                                   const ptrdiff_t* offsets, int count) {
    const hn::Full128<int16_t> d16;
    const hn::Full128<int32_t> d32;
    auto even = hn::Zero(d32), odd = hn::Zero(d32);
    for (int t = 0; t < count; t++) {
      const auto difference = hn::Sub(hn::Load(d16, wanted[t].data()), hn::LoadU(d16, centre[offsets[t]].data()));
      even = hn::ReorderWidenMulAccumulate(d32, difference, difference, even, odd);
    }
    return hn::GetLane(hn::SumOfLanes(d32, hn::Add(even, odd)));
  }
  HWY_ATTR static void copy(const AppearanceVector& from, AppearanceVector& to) {
    const hn::Full128<int16_t> d16;
    hn::Store(hn::LoadU(d16, from.data()), d16, to.data());
  }
#endif

  /// Distance of the window around an exemplar pixel to what is wanted; gives up once it exceeds the limit.
  HWY_ATTR uint32_t distance(int x, int y, uint64_t limit) const {
    const AppearanceVector* centre = level_.exemplar.at(x, y);
    uint32_t total = 0;
    for (int t = 0; t < count_ && total <= limit; t += taps_at_once)
      total += uint32_t(tap_distance(&wanted_[t], centre, &offsets_[t], HWY_MIN(taps_at_once, count_ - t)));
    return total;
  }

  static constexpr int taps_at_once = 8;
  static constexpr double most_factor = 1e9;
  static constexpr int ring_radii[3] = {1, 3, 6};
  static constexpr int most_taps = 24;
  static constexpr int most_candidates = 128;
  const Field& field_;
  const CorrectionLevel& level_;
  const CorrectionPass& pass_;
  const Occupancy& occupancy_;
  int taps_;
  int x_ = 0, y_ = 0;
  const uint8_t* target_ = nullptr;
  int ring_count_ = 0;
  struct RingPixel {
    int x, y, radius;
  };
  std::array<RingPixel, 24> ring_{};
  int count_ = 0;
  int seen_ = 0;
  uint64_t best_cost_ = 0;
  ExemplarPixel best_;
  std::array<const ExemplarPixel*, 9> around_{};
  std::array<ptrdiff_t, most_taps> all_offsets_{};
  std::array<ptrdiff_t, most_taps> offsets_{};
  std::array<uint32_t, most_candidates> seen_ids_{};
  alignas(16) std::array<AppearanceVector, most_taps> wanted_{};
};

template <bool steered>
HWY_ATTR void correct_pixels(const Field& field, const CorrectionLevel& level, const CorrectionPass& pass,
                             const Occupancy& occupancy, int first, int y, ExemplarPixel* out) {
  PixelCorrector<steered> corrector(field, level, pass, occupancy);
  for (int x = first; x < field.size.width; x += 2, out++)
    *out = level.fixed.at(size_t(y) * field.size.width + x) ? field.at(x, y) : corrector.best(x, y);
}

/// Every second pixel of a row, from `first` on, into `out`.
HWY_ATTR void correct_row(const Field& field, const CorrectionLevel& level, const CorrectionPass& pass,
                          const Occupancy& occupancy, int first, int y, ExemplarPixel* out) {
  const auto correct = level.control || level.exemplar.masked() ? correct_pixels<true> : correct_pixels<false>;
  correct(field, level, pass, occupancy, first, y, out);
}

}  // namespace HWY_NAMESPACE
}  // namespace terrazzo
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace terrazzo {

HWY_EXPORT(correct_row);

namespace {

Window sorted_window(int radius) {
  Window w;
  for (int j = -radius; j <= radius; j++)
    for (int i = -radius; i <= radius; i++)
      if (i || j) w.push_back({i, j});
  std::stable_sort(w.begin(), w.end(),
                   [](const auto& a, const auto& b) { return a[0] * a[0] + a[1] * a[1] < b[0] * b[0] + b[1] * b[1]; });
  return w;
}

}  // namespace

const Window& full_window() {
  static const Window window = sorted_window(2);
  return window;
}

const Window& sparse_window() {
  static const Window window = {{-1, -1}, {1, -1}, {-1, 1}, {1, 1}, {0, -2}, {0, 2}, {-2, 0}, {2, 0}};
  return window;
}

void correct(Field& field, const CorrectionLevel& level, const CorrectionPass& pass, Occupancy& occupancy,
             const Task& task) {
  const Size size = field.size;
  std::vector<ExemplarPixel> next;
  for (int sub = 0; sub < 4; sub++) {
    occupancy.recount(field, level.fixed);
    const int first_x = (sub ^ pass.pass) & 1, first_y = sub >> 1;
    const int columns = (size.width - first_x + 1) / 2, rows = (size.height - first_y + 1) / 2;
    if (columns <= 0 || rows <= 0) continue;
    next.resize(size_t(columns) * rows);
    tbb::parallel_for(0, rows, [&](int row) {
      task.check();
      HWY_DYNAMIC_DISPATCH(correct_row)
      (field, level, pass, occupancy, first_x, first_y + 2 * row, &next[size_t(row) * columns]);
    });
    tbb::parallel_for(0, rows, [&](int row) {
      for (int i = 0; i < columns; i++) field.at(first_x + 2 * i, first_y + 2 * row) = next[size_t(row) * columns + i];
    });
  }
}

}  // namespace terrazzo
#endif
