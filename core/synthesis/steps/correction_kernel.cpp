#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/synthesis/steps/correction_kernel.cpp"
#include "core/synthesis/steps/correction_kernel.h"

#include <array>

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "core/base/geometry.h"
#include "core/base/hash.h"
#include "core/synthesis/steps/candidate_set.h"

HWY_BEFORE_NAMESPACE();
namespace terrazzo {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// Corrects single pixels: gathers their neighbourhoods, collects candidates and picks the best. One per thread and
/// tile. `steered`: the exemplar has a mask or the level has controls.
template <bool steered>
class PixelCorrector {
 public:
  explicit PixelCorrector(const CorrectionInputs& inputs)
      : field_(inputs.field),
        level_(inputs.level),
        plane_(level_.window.field()),
        pass_(inputs.pass),
        usage_(inputs.usage),
        exemplar_(level_.exemplar.at(0, 0)),
        stride_(level_.exemplar.stride()),
        pass_bits_(random_bits(pass_.seed, level_.level, pass_.pass)),
        repeat_penalty_(inputs.repeat_penalty),
        taps_(int(pass_.window->size())),
        candidates_(level_, !pass_.piece_coherence.empty() || pass_.coherence > unit_factor) {
    for (int t = 0; t < taps_; t++) {
      const auto [dx, dy] = (*pass_.window)[t];
      exemplar_offsets_[t] = dy * stride_ + dx;
      field_offsets_[t] = ptrdiff_t{dy} * field_.size.width + dx;
      continued_[t] = packed(dx, dy);
    }
    for (int n = 0; n < 9; n++) around_offsets_[n] = ptrdiff_t{step(n, 1)} * field_.size.width + step(n, 0);
  }

  HWY_ATTR ExemplarPixel best(int x, int y) {
    const ExemplarPixel* own = &field_.at(x, y);
    const bool inside = is_inside(x, y);
    if (!steered && inside && continues_all_around(own)) return *own;
    x_ = level_.window.x(x);
    y_ = level_.window.y(y);
    nearby_ = usage_.nearby_factors(x_, y_);
    if constexpr (steered)
      if (level_.control) target_ = level_.control->target(int64_t(level_.window.index(x, y)));
    if (inside)
      gather_inside(own);
    else
      gather_at_border(x, y);
    if (level_.elements) own_element_ = element_at(own->x, own->y);
    best_cost_ = ~uint64_t{0};
    best_ = *own;
    candidates_.clear();
    candidates_.add_continued(own->x, own->y, coherence(own));
    consider(candidates_.id(0), candidates_.factor(0), tap_distance(exemplar_at(candidates_.id(0)), 0));
    // Nothing is cheaper than what costs nothing, as inside a piece of the exemplar.
    if (best_cost_ == 0) return best_;
    propose_others();
    compare_nearest(1);
    const size_t continued = candidates_.continued(), count = candidates_.count();
    for (size_t i = 1; i < continued; i++) consider(candidates_.id(i), candidates_.factor(i), nearest_[i]);
    for (size_t i = continued; i < count; i++) consider(candidates_.id(i), unit_factor, nearest_[i]);
    return best_;
  }

 private:
  static constexpr int step(int n, int axis) { return CandidateSet::step(n, axis); }

  /// Whether all neighbours lie within the field.
  bool is_inside(int x, int y) const {
    constexpr int reach = ring_radii[rings - 1];
    return x >= reach && y >= reach && x < field_.size.width - reach && y < field_.size.height - reach;
  }

  /// Whether the pixel and its window show one connected part of the exemplar: the cost is 0 then.
  bool continues_all_around(const ExemplarPixel* centre) const {
    const uint32_t own = packed(*centre);
    for (int t = 0; t < taps_; t++)
      if (packed(centre[field_offsets_[t]]) != own + continued_[t]) return false;
    return true;
  }

  uint16_t element_at(int x, int y) const {
    return level_.elements[size_t(y) * size_t(level_.exemplar.size().width) + size_t(x)];
  }

  uint32_t coherence(const ExemplarPixel* continued) const {
    if (pass_.piece_coherence.empty()) return pass_.coherence;
    return pass_.piece_coherence[size_t(continued - field_.pixels.data())];
  }

  /// The field's pixel at (x, y); null beyond the border of an output that does not tile.
  const ExemplarPixel* neighbour(int x, int y) const {
    const int64_t i = plane_.index(x, y);
    return i < 0 ? nullptr : &field_.pixels[size_t(i)];
  }

  HWY_ATTR void gather_inside(const ExemplarPixel* centre) {
    for (int n = 0; n < 9; n++) around_[n] = centre + around_offsets_[n];
    for (int r = 0; r < rings; r++)
      for (int n = 0; n < 8; n++) ring_ids_[r][n] = packed(centre[ring_radii[r] * around_offsets_[n + 1]]);
    for (int t = 0; t < taps_; t++) want(t, centre[field_offsets_[t]], exemplar_offsets_[t]);
    count_ = taps_;
  }

  HWY_ATTR void gather_at_border(int x, int y) {
    for (int n = 0; n < 9; n++) around_[n] = neighbour(x + step(n, 0), y + step(n, 1));
    for (int r = 0; r < rings; r++)
      for (int n = 0; n < 8; n++) {
        const ExemplarPixel* p = neighbour(x + ring_radii[r] * step(n + 1, 0), y + ring_radii[r] * step(n + 1, 1));
        ring_ids_[r][n] = p ? packed(*p) : CandidateSet::no_id;
      }
    count_ = 0;
    for (int t = 0; t < taps_; t++) {
      const auto [dx, dy] = (*pass_.window)[t];
      if (const ExemplarPixel* p = neighbour(x + dx, y + dy)) want(count_++, *p, exemplar_offsets_[t]);
    }
  }

  /// Stores what a pixel of the window shows, and its offset from a candidate's centre.
  HWY_INLINE HWY_ATTR void want(int tap, const ExemplarPixel& shown, ptrdiff_t offset) {
    copy(exemplar_[shown.y * stride_ + shown.x], wanted_[tap]);
    offsets_[tap] = offset;
  }

  HWY_ATTR void propose_others() {
    for (int n = 1; n < 9; n++)
      if (around_[n])
        candidates_.add_continued(around_[n]->x - step(n, 0), around_[n]->y - step(n, 1), coherence(around_[n]));
    // Those beside the pixel in one pass, those across the corners in the next: half the candidates serve as well.
    const int first = pass_.pass % 2 == 0 ? 1 : 5;
    candidates_.propose_similar(*around_[0], 0);
    for (int n = first; n < first + 4; n++)
      if (around_[n]) candidates_.propose_similar(*around_[n], n);
    const uint64_t bits = more_random_bits(pass_bits_, x_, y_);
    for (int k = 0; k < pass_.random_candidates; k++) {
      auto [u, v] = level_.exemplar.place(more_random_bits(bits, k));
      level_.phase.snap(x_, y_, u, v);
      candidates_.propose(u, v);
    }
    candidates_.add_proposed();
  }

  const AppearanceVector* exemplar_at(uint32_t id) const {
    return exemplar_ + (ptrdiff_t(id >> 16) * stride_ + ptrdiff_t(id & 0xffff));
  }

  /// `nearest`: its distance in the nearest pixels of the window, which rejects most candidates before terms that take
  /// longer and only raise the cost.
  HWY_INLINE HWY_ATTR void consider(uint32_t id, uint32_t factor, uint32_t nearest) {
    const int x = int(id & 0xffff), y = int(id >> 16);
    if (level_.elements && element_at(x, y) != own_element_) return;
    uint64_t difference = nearest;
    if constexpr (steered) {
      if (!level_.exemplar.is_usable(x, y)) return;
      if (level_.control) difference += level_.control->cost(x, y, target_) * uint64_t(count_);
    }
    if (usage_.active()) factor = uint32_t((uint64_t{factor} * usage_.factor(x, y)) / unit_factor);
    if (nearby_) factor = uint32_t(uint64_t{factor} * nearby_[usage_.cell(x, y)] / unit_factor);
    if (difference * factor >= best_cost_) return;
    factor += uint32_t(uint64_t{factor} * repeat_penalty_ / unit_factor) * repeats(id);
    if (level_.phase.active()) factor = uint32_t(std::min(most_factor, factor * level_.phase.penalty(x, y, x_, y_)));
    const AppearanceVector* centre = exemplar_at(id);
    for (int t = taps_at_once; t < count_ && difference * factor < best_cost_; t += taps_at_once)
      difference += tap_distance(centre, t);
    if (difference * factor >= best_cost_) return;
    best_cost_ = difference * factor;
    best_ = {uint16_t(x), uint16_t(y)};
  }

  HWY_ATTR void compare_nearest_one_by_one(size_t first) {
    for (size_t i = first; i < candidates_.count(); i++) nearest_[i] = tap_distance(exemplar_at(candidates_.id(i)), 0);
  }

#if HWY_TARGET == HWY_SCALAR
  void compare_nearest(size_t first) {
    compare_nearest_one_by_one(first);
  }
  uint32_t repeats(uint32_t id) const {
    const auto is_near = [](uint32_t a, uint32_t b, int radius) { return 2 * std::abs(int(a) - int(b)) < radius; };
    uint32_t count = 0;
    for (int r = 0; r < rings; r++)
      for (const uint32_t other : ring_ids_[r])
        count += is_near(id & 0xffff, other & 0xffff, ring_radii[r]) && is_near(id >> 16, other >> 16, ring_radii[r]);
    return count;
  }
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
  /// The distances of the candidates from `first` on in the nearest pixels of the window. Four at once: none waits for
  /// the sum of another's.
  HWY_ATTR void compare_nearest(size_t first) {
    if (count_ < taps_at_once) return compare_nearest_one_by_one(first);
    const hn::Full128<int32_t> d;
    const uint32_t* ids = candidates_.ids();
    for (size_t i = first; i < candidates_.count(); i += 4) {
      const auto a = first_taps(ids[i]), b = first_taps(ids[i + 1]);
      const auto c = first_taps(ids[i + 2]), e = first_taps(ids[i + 3]);
      const auto ab = hn::Add(hn::InterleaveLower(d, a, b), hn::InterleaveUpper(d, a, b));
      const auto ce = hn::Add(hn::InterleaveLower(d, c, e), hn::InterleaveUpper(d, c, e));
      const auto sums = hn::Add(hn::ConcatLowerLower(d, ce, ab), hn::ConcatUpperUpper(d, ce, ab));
      hn::StoreU(hn::BitCast(hn::Full128<uint32_t>(), sums), hn::Full128<uint32_t>(), &nearest_[i]);
    }
  }
  /// Parts of the squared distance in the first pixels of the window.
  HWY_INLINE HWY_ATTR hn::Vec<hn::Full128<int32_t>> first_taps(uint32_t id) const {
    const hn::Full128<int16_t> d16;
    const hn::Full128<int32_t> d32;
    const AppearanceVector* centre = exemplar_at(id);
    auto even = hn::Zero(d32), odd = hn::Zero(d32);
#pragma GCC unroll 8
    for (int t = 0; t < taps_at_once; t++) {
      const auto difference = hn::Sub(hn::Load(d16, wanted_[t].data()), hn::LoadU(d16, centre[offsets_[t]].data()));
      even = hn::ReorderWidenMulAccumulate(d32, difference, difference, even, odd);
    }
    return hn::Add(even, odd);
  }

  /// How many pixels of the rings show nearly what the candidate would show here. Pieces that repeat after a few pixels
  /// make combed streaks, pixels that repeat at once make waffles.
  HWY_INLINE HWY_ATTR uint32_t repeats(uint32_t id) const {
    const hn::CappedTag<uint32_t, 8> d32;
    const hn::Repartition<uint16_t, decltype(d32)> d16;
    const auto own = hn::BitCast(d16, hn::Set(d32, id));
    auto count = hn::Zero(d32);
    for (int r = 0; r < rings; r++)
      for (size_t n = 0; n < 8; n += hn::Lanes(d32)) {
        const auto other = hn::BitCast(d16, hn::Load(d32, &ring_ids_[r][n]));
        const auto apart = hn::Or(hn::SaturatedSub(own, other), hn::SaturatedSub(other, own));
        // By how much x or y are farther apart than the largest distance whose double is below the radius.
        const auto beyond = hn::SaturatedSub(apart, hn::Set(d16, uint16_t((ring_radii[r] - 1) / 2)));
        const auto is_near = hn::Eq(hn::BitCast(d32, beyond), hn::Zero(d32));
        count = hn::Add(count, hn::IfThenElseZero(is_near, hn::Set(d32, 1)));
      }
    return hn::GetLane(hn::SumOfLanes(d32, count));
  }

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
  static constexpr double most_factor = 1e9;  // times a window's greatest distance it fits 64 bits
  // Where repeats are searched: without 1 and 3 waffles come, without 6 streaks (experiments.md, "correction").
  static constexpr int rings = 3;
  static constexpr int ring_radii[rings] = {1, 3, correction_reach};
  static constexpr int most_taps = most_window_pixels;

  const Field& field_;
  const CorrectionLevel& level_;
  const Plane plane_;  // the field's
  const CorrectionPass& pass_;
  const UsagePenalty& usage_;
  const AppearanceVector* exemplar_;  // its first pixel
  ptrdiff_t stride_;
  uint64_t pass_bits_;
  uint32_t repeat_penalty_;  // in unit_factor
  int taps_;
  std::array<ptrdiff_t, 9> around_offsets_{};
  std::array<ptrdiff_t, most_taps> field_offsets_{}, exemplar_offsets_{};
  std::array<uint32_t, most_taps> continued_{};  // by how much ids exceed the centre's where the window continues it

  // Of the pixel under way:
  int x_ = 0, y_ = 0;         // in the plane
  uint16_t own_element_ = 0;  // that the pixel shows
  const uint8_t* target_ = nullptr;
  const uint16_t* nearby_ = nullptr;  // of every cell: the factor for what shows near by
  std::array<const ExemplarPixel*, 9> around_;
  alignas(32) std::array<std::array<uint32_t, 8>, rings> ring_ids_;
  int count_ = 0;  // pixels of the window
  std::array<ptrdiff_t, most_taps> offsets_;
  alignas(16) std::array<AppearanceVector, most_taps> wanted_;
  CandidateSet candidates_;
  CandidateSet::ForEach<uint32_t> nearest_;  // of each candidate: the distance in the first pixels of the window
  uint64_t best_cost_ = 0;
  ExemplarPixel best_;
};

template <bool steered>
HWY_ATTR void correct_pixels(const CorrectionInputs& inputs, const SubPass& part, const Rect& tile,
                             ExemplarPixel* out) {
  PixelCorrector<steered> corrector(inputs);
  const Field& field = inputs.field;
  const CorrectionLevel& level = inputs.level;
  for (int row = tile.y; row < tile.bottom(); row++)
    for (int column = tile.x; column < tile.right(); column++) {
      const int x = part.x(column), y = part.y(row);
      out[size_t(row) * part.columns + column] = level.is_fixed(x, y) ? field.at(x, y) : corrector.best(x, y);
    }
}

HWY_ATTR void correct_tile(const CorrectionInputs& inputs, const SubPass& part, const Rect& tile, ExemplarPixel* out) {
  const bool steered = inputs.level.control || inputs.level.exemplar.masked();
  (steered ? correct_pixels<true> : correct_pixels<false>)(inputs, part, tile, out);
}

}  // namespace HWY_NAMESPACE
}  // namespace terrazzo
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace terrazzo {

HWY_EXPORT(correct_tile);

void correct_tile(const CorrectionInputs& inputs, const SubPass& part, const Rect& tile, ExemplarPixel* out) {
  HWY_DYNAMIC_DISPATCH(correct_tile)(inputs, part, tile, out);
}

}  // namespace terrazzo
#endif
