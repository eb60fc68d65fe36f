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
      : field_(field),
        level_(level),
        pass_(pass),
        occupancy_(occupancy),
        taps_(int(pass.window->size())),
        dear_coherence_(!pass.piece_coherence.empty() || pass.coherence > unit_factor) {
    for (int t = 0; t < taps_; t++) {
      const auto [dx, dy] = (*pass.window)[t];
      exemplar_offsets_[t] = dy * level.exemplar.stride() + dx;
      field_offsets_[t] = dy * field.size.width + dx;
      continued_[t] = packed(dx, dy);
    }
  }

  HWY_ATTR ExemplarPixel best(int x, int y) {
    const ExemplarPixel own = field_.at(x, y);
    const bool inside = is_inside(x, y);
    if (!steered && inside && continues_all_around(&field_.at(x, y))) return own;
    if (inside)
      gather([centre = &field_.at(x, y), width = field_.size.width](int dx, int dy) {
        return centre + ptrdiff_t{dy} * width + dx;
      });
    else
      gather([&](int dx, int dy) { return neighbour(x + dx, y + dy); });
    x_ = level_.window.x(x);
    y_ = level_.window.y(y);
    if constexpr (steered)
      if (level_.control) target_ = level_.control->target(int64_t(level_.window.index(x, y)));
    candidates_ = 0;
    best_cost_ = ~uint64_t{0};
    best_ = own;
    propose_continued(own.x, own.y, coherence(around_[0]));
    consider_from(0);
    // Nothing is cheaper than what costs nothing, as inside a piece of the exemplar.
    if (best_cost_ == 0) return best_;
    propose_others();
    consider_from(1);
    return best_;
  }

 private:
  HWY_ATTR void propose_others() {
    for (int n = 1; n < 9; n++)
      if (around_[n]) propose_continued(around_[n]->x - step(n, 0), around_[n]->y - step(n, 1), coherence(around_[n]));
    continued_candidates_ = candidates_;
    recent_.fill(no_id);
    for (int n = 0; n < 9; n++) {
      if (!around_[n]) continue;
      const size_t at = size_t(around_[n]->y) * level_.exemplar.size().width + around_[n]->x;
      const ExemplarPixel* similar = &level_.similar[at * level_.per_pixel];
      for (int k = 0; k < level_.per_pixel; k++) propose(similar[k].x - step(n, 0), similar[k].y - step(n, 1));
    }
    for (int k = 0; k < pass_.random_candidates; k++) {
      const uint64_t r = random_bits(pass_.seed, level_.level, pass_.pass, x_, y_, k);
      auto [u, v] = level_.exemplar.place(r);
      level_.phase.snap(x_, y_, u, v);
      propose(u, v);
    }
  }

  static uint32_t packed(int x, int y) { return uint32_t(y) << 16 | uint32_t(x); }

  /// Far enough from the border that no neighbour needs looking for.
  bool is_inside(int x, int y) const {
    constexpr int reach = ring_radii[2];
    return x >= reach && y >= reach && x < field_.size.width - reach && y < field_.size.height - reach;
  }

  /// Whether the pixel and its window show one connected place of the exemplar: they then fit without any difference.
  bool continues_all_around(const ExemplarPixel* centre) const {
    const uint32_t own = packed(centre->x, centre->y);
    for (int t = 0; t < taps_; t++) {
      const ExemplarPixel& p = centre[field_offsets_[t]];
      if (packed(p.x, p.y) != own + continued_[t]) return false;
    }
    return true;
  }

  uint32_t coherence(const ExemplarPixel* continued) const {
    if (pass_.piece_coherence.empty()) return pass_.coherence;
    return pass_.piece_coherence[size_t(continued - field_.pixels.data())];
  }

  static int step(int n, int axis) {
    constexpr int steps[9][2] = {{0, 0}, {-1, 0}, {1, 0}, {0, -1}, {0, 1}, {-1, -1}, {1, -1}, {-1, 1}, {1, 1}};
    return steps[n][axis];
  }

  /// The pixel at a place; null beyond the border of an output that does not tile.
  const ExemplarPixel* neighbour(int x, int y) const {
    const int64_t i = pixel_index(field_.size, x, y, level_.window.closed_x, level_.window.closed_y);
    return i < 0 ? nullptr : &field_.pixels[size_t(i)];
  }

  /// `look(dx, dy)`: the pixel at an offset, or null.
  template <typename Look>
  HWY_INLINE HWY_ATTR void gather(const Look& look) {
    for (int n = 0; n < 9; n++) around_[n] = look(step(n, 0), step(n, 1));
    for (int r = 0; r < rings; r++)
      for (int n = 0; n < 8; n++) {
        const ExemplarPixel* p = look(ring_radii[r] * step(n + 1, 0), ring_radii[r] * step(n + 1, 1));
        ring_present_[r][n] = p ? uint16_t{1} : uint16_t{0};
        ring_x_[r][n] = p ? p->x : uint16_t{0};
        ring_y_[r][n] = p ? p->y : uint16_t{0};
      }
    count_ = 0;
    for (int t = 0; t < taps_; t++) {
      const auto [dx, dy] = (*pass_.window)[t];
      const ExemplarPixel* p = look(dx, dy);
      if (!p) continue;
      copy(*level_.exemplar.at(p->x, p->y), wanted_[count_]);
      offsets_[count_++] = exemplar_offsets_[t];
    }
  }

  /// False if the place is not usable.
  HWY_INLINE bool settles(int& x, int& y) const {
    if constexpr (steered) return level_.exemplar.settles(x, y);
    level_.exemplar.settle_inside(x, y);
    return true;
  }

  void propose_continued(int x, int y, uint32_t factor) {
    if (!settles(x, y)) return;
    const uint32_t id = packed(x, y);
    for (size_t i = 0; i < candidates_; i++)
      if (ids_[i] == id) return;
    ids_[candidates_] = id;
    factors_[candidates_++] = factor;
  }

  /// Adds a candidate that continues nothing. To meet one twice would cost time only, and so most are told by the
  /// places they hash to; but one that continues a neighbour must not come back without its factor.
  HWY_INLINE void propose(int x, int y) {
    if (!settles(x, y)) return;
    const uint32_t id = packed(x, y);
    uint32_t& recent = recent_[(id * 0x9e3779b1u) >> (32 - recent_bits)];
    bool is_new = recent != id;
    recent = id;
    if (dear_coherence_)
      for (size_t i = 0; i < continued_candidates_; i++) is_new &= ids_[i] != id;
    ids_[candidates_] = id;
    factors_[candidates_] = unit_factor;
    candidates_ += is_new;
  }

  /// How many of the pixels a little way off show nearly what the candidate would show here. A piece that comes back
  /// after a few pixels makes combed streaks, a pixel that comes back at once makes waffles.
  HWY_INLINE HWY_ATTR uint32_t repeats(int x, int y) const {
    const hn::CappedTag<uint16_t, 8> d;
    const auto u = hn::Set(d, uint16_t(x)), v = hn::Set(d, uint16_t(y));
    const auto distance = [](auto a, auto b)
                              HWY_ATTR { return hn::Or(hn::SaturatedSub(a, b), hn::SaturatedSub(b, a)); };
    auto count = hn::Zero(d);
    for (int r = 0; r < rings; r++)
      for (size_t n = 0; n < 8; n += hn::Lanes(d)) {
        const auto apart = hn::Max(distance(hn::Load(d, &ring_x_[r][n]), u), distance(hn::Load(d, &ring_y_[r][n]), v));
        const auto near = hn::Lt(apart, hn::Set(d, uint16_t((ring_radii[r] + 1) / 2)));
        count = hn::Add(count, hn::IfThenElseZero(near, hn::Load(d, &ring_present_[r][n])));
      }
    return hn::GetLane(hn::SumOfLanes(d, count));
  }

  HWY_ATTR void consider_from(size_t first) {
    for (size_t i = first; i < candidates_; i++) consider(int(ids_[i] & 0xffff), int(ids_[i] >> 16), factors_[i]);
  }

  HWY_INLINE HWY_ATTR void consider(int x, int y, uint32_t factor) {
    if (occupancy_.active()) factor = uint32_t((uint64_t{factor} * occupancy_.factor(x, y)) / unit_factor);
    const AppearanceVector* centre = level_.exemplar.at(x, y);
    uint64_t difference = 0;
    if constexpr (steered)
      if (level_.control) difference = level_.control->cost(x, y, target_) * uint64_t(count_);
    // The nearest pixels tell most candidates off, before the dearer terms, which only raise the cost.
    difference += tap_distance(centre, 0);
    if (difference * factor >= best_cost_) return;
    factor += factor / 2 * repeats(x, y);
    if (level_.phase.active()) factor = uint32_t(std::min(most_factor, factor * level_.phase.penalty(x, y, x_, y_)));
    for (int t = taps_at_once; t < count_ && difference * factor < best_cost_; t += taps_at_once)
      difference += tap_distance(centre, t);
    if (difference * factor >= best_cost_) return;
    best_cost_ = difference * factor;
    best_ = {uint16_t(x), uint16_t(y)};
  }

#if HWY_TARGET == HWY_SCALAR
  uint32_t tap_distance(const AppearanceVector* centre, int first) const {
    uint32_t sum = 0;
    for (int t = first; t < std::min(first + taps_at_once, count_); t++)
      sum += uint32_t(squared_distance(wanted_[t], centre[offsets_[t]]));
    return sum;
  }
  static void copy(const AppearanceVector& from, AppearanceVector& to) {
    to = from;
  }
#else
  /// The squared distance of `taps_at_once` pixels of the window, or as many as there are, from the `first` one on.
  HWY_INLINE HWY_ATTR uint32_t tap_distance(const AppearanceVector* centre, int first) const {
    const hn::Full128<int16_t> d16;
    const hn::Full128<int32_t> d32;
    auto even = hn::Zero(d32), odd = hn::Zero(d32);
    const auto add = [&](int t) HWY_ATTR {
      const auto difference = hn::Sub(hn::Load(d16, wanted_[t].data()), hn::LoadU(d16, centre[offsets_[t]].data()));
      even = hn::ReorderWidenMulAccumulate(d32, difference, difference, even, odd);
    };
    if (first + taps_at_once <= count_) {
#pragma GCC unroll 8
      for (int t = 0; t < taps_at_once; t++) add(first + t);
    } else {
      for (int t = first; t < count_; t++) add(t);
    }
    return uint32_t(hn::GetLane(hn::SumOfLanes(d32, hn::Add(even, odd))));
  }
  HWY_INLINE HWY_ATTR static void copy(const AppearanceVector& from, AppearanceVector& to) {
    const hn::Full128<int16_t> d16;
    hn::Store(hn::LoadU(d16, from.data()), d16, to.data());
  }
#endif

  static constexpr int taps_at_once = 8;
  static constexpr double most_factor = 1e9;
  static constexpr int rings = 3;
  static constexpr int ring_radii[rings] = {1, 3, correction_reach};
  static constexpr int most_taps = 24;
  static constexpr int most_candidates = 128;
  static constexpr int recent_bits = 7;
  static constexpr uint32_t no_id = ~uint32_t{0};  // a place that no exemplar that fits into memory has
  using RingValues = std::array<std::array<uint16_t, 8>, rings>;

  const Field& field_;
  const CorrectionLevel& level_;
  const CorrectionPass& pass_;
  const Occupancy& occupancy_;
  int taps_;
  int x_ = 0, y_ = 0;  // in the plane
  const uint8_t* target_ = nullptr;
  int count_ = 0;
  bool dear_coherence_;  // it may cost more to continue a neighbour than not to
  size_t candidates_ = 0, continued_candidates_ = 0;
  uint64_t best_cost_ = 0;
  ExemplarPixel best_;
  std::array<const ExemplarPixel*, 9> around_{};
  std::array<ptrdiff_t, most_taps> field_offsets_{}, exemplar_offsets_{};
  std::array<uint32_t, most_taps>
      continued_{};  // what a pixel of the window has more than its centre, if it continues it
  std::array<ptrdiff_t, most_taps> offsets_{};
  std::array<uint32_t, most_candidates> ids_{}, factors_{};
  std::array<uint32_t, 1 << recent_bits> recent_{};
  alignas(16) RingValues ring_x_{}, ring_y_{}, ring_present_{};
  alignas(16) std::array<AppearanceVector, most_taps> wanted_{};
};

template <bool steered>
HWY_ATTR void correct_pixels(const Field& field, const CorrectionLevel& level, const CorrectionPass& pass,
                             const Occupancy& occupancy, EverySecond columns, int y, ExemplarPixel* out) {
  PixelCorrector<steered> corrector(field, level, pass, occupancy);
  for (int i = 0; i < columns.count; i++) {
    const int x = columns.at(i);
    out[i] = level.fixed.any() && level.fixed.at(level.window.index(x, y)) ? field.at(x, y) : corrector.best(x, y);
  }
}

/// Some pixels of a row, into `out`.
HWY_ATTR void correct_row(const Field& field, const CorrectionLevel& level, const CorrectionPass& pass,
                          const Occupancy& occupancy, EverySecond columns, int y, ExemplarPixel* out) {
  const auto correct = level.control || level.exemplar.masked() ? correct_pixels<true> : correct_pixels<false>;
  correct(field, level, pass, occupancy, columns, y, out);
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
  std::vector<ExemplarPixel> next;
  for (int sub = 0; sub < sub_passes; sub++) {
    occupancy.recount(field, level.fixed);
    // What the sub-passes that follow look at has to be right as well.
    const Rect r = intersect(whole(field.size), grown(pass.wanted, correction_reach * (sub_passes - 1 - sub)));
    const EverySecond columns = level.window.columns(r, (sub ^ pass.pass) & 1);
    const EverySecond rows = level.window.rows(r, sub >> 1);
    if (columns.count <= 0 || rows.count <= 0) continue;
    next.resize(size_t(columns.count) * rows.count);
    tbb::parallel_for(0, rows.count, [&](int row) {
      task.check();
      HWY_DYNAMIC_DISPATCH(correct_row)
      (field, level, pass, occupancy, columns, rows.at(row), &next[size_t(row) * columns.count]);
    });
    tbb::parallel_for(0, rows.count, [&](int row) {
      for (int i = 0; i < columns.count; i++)
        field.at(columns.at(i), rows.at(row)) = next[size_t(row) * columns.count + i];
    });
  }
}

}  // namespace terrazzo
#endif
