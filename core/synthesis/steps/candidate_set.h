// Compiled once for every instruction set, as correction_kernel.cpp is, which includes it.
#if defined(TERRAZZO_CANDIDATE_SET) == defined(HWY_TARGET_TOGGLE)
#ifdef TERRAZZO_CANDIDATE_SET
#undef TERRAZZO_CANDIDATE_SET
#else
#define TERRAZZO_CANDIDATE_SET
#endif

#include <array>

#include <hwy/highway.h>

#include "core/synthesis/state/correction_level.h"
#include "core/synthesis/state/field.h"
#include "core/synthesis/steps/correction_pass.h"

HWY_BEFORE_NAMESPACE();
namespace terrazzo {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// The candidates of one pixel, told apart: first those that continue a neighbour, each with its coherence factor, then
/// the others. An id is a packed() exemplar position.
class CandidateSet {
 public:
  static constexpr uint32_t no_id = ~uint32_t{0};  // no exemplar is so large
  static constexpr int most = 128;
  template <typename T>
  using ForEach = std::array<T, most>;

  /// `coherence_may_cost`: continuing a neighbour may cost more than other candidates.
  CandidateSet(const CorrectionLevel& level, bool coherence_may_cost)
      : level_(level), width_(size_t(level.exemplar.size().width)), coherence_may_cost_(coherence_may_cost) {
    for (int n = 0; n < 9; n++) {
      forth_[n] = packed(step(n, 0) < 0, step(n, 1) < 0);
      back_[n] = packed(step(n, 0) > 0, step(n, 1) > 0);
    }
    const int keep_off = level.exemplar.keep_off();
    const Size size = level.exemplar.size();
    least_ = packed(keep_off, keep_off);
    most_ = packed(size.width - 1 - keep_off, size.height - 1 - keep_off);
    below_ = level.exemplar.wraps() ? most_ : least_;
    beyond_ = level.exemplar.wraps() ? least_ : most_;
  }

  /// Steps to a pixel itself and its eight neighbours.
  static constexpr int step(int n, int axis) {
    constexpr int steps[9][2] = {{0, 0}, {-1, 0}, {1, 0}, {0, -1}, {0, 1}, {-1, -1}, {1, -1}, {-1, 1}, {1, 1}};
    return steps[n][axis];
  }

  size_t count() const { return count_; }
  size_t continued() const { return continued_; }
  const uint32_t* ids() const { return ids_.data(); }
  uint32_t id(size_t i) const { return ids_[i]; }
  uint32_t factor(size_t i) const { return factors_[i]; }

  void clear() { count_ = continued_ = proposed_count_ = 0; }
  /// Adds what continues a neighbour at (x, y).
  HWY_INLINE void add_continued(int x, int y, uint32_t factor) {
    level_.exemplar.settle_inside(x, y);
    const uint32_t id = packed(x, y);
    for (size_t i = 0; i < count_; i++)
      if (ids_[i] == id) return;
    ids_[count_] = id;
    factors_[count_++] = factor;
    continued_ = count_;
  }
  void propose(int x, int y) {
    level_.exemplar.settle_inside(x, y);
    proposed_[proposed_count_++] = packed(x, y);
  }
  /// Proposes the k-coherent candidates of what the n-th neighbour shows.
  HWY_INLINE HWY_ATTR void propose_similar(const ExemplarPixel& shown, int n) {
    const auto per_pixel = size_t(level_.per_pixel);
    const size_t first = (shown.y * width_ + shown.x) * per_pixel;
#if HWY_TARGET != HWY_SCALAR
    // Four at once, x and y in turn; what is read and written beyond the last one does not count.
    if (first + (per_pixel + 3) / 4 * 4 <= level_.similar.size()) {
      const hn::Full128<uint16_t> d;
      const hn::Full128<uint32_t> both;
      const auto of = [&](uint32_t id) HWY_ATTR { return hn::BitCast(d, hn::Set(both, id)); };
      const auto forth = of(forth_[n]), back = of(back_[n]), one = hn::Set(d, 1);
      const auto least = hn::Add(of(least_), one), most = hn::Add(of(most_), one);
      const auto below = of(below_), beyond = of(beyond_);
      for (size_t k = 0; k < per_pixel; k += 4) {
        const auto similar = hn::LoadU(d, &level_.similar[first + k].x);
        const auto next = hn::Sub(hn::Add(hn::Add(similar, one), forth), back);  // and one more: none is negative
        const auto inside = hn::IfThenElse(hn::Ne(hn::Max(next, least), next), below, hn::Sub(next, one));
        const auto settled = hn::IfThenElse(hn::Ne(hn::Min(next, most), next), beyond, inside);
        hn::StoreU(hn::BitCast(both, settled), both, &proposed_[proposed_count_ + k]);
      }
      proposed_count_ += per_pixel;
      return;
    }
#endif
    for (size_t k = 0; k < per_pixel; k++)
      propose(level_.similar[first + k].x - step(n, 0), level_.similar[first + k].y - step(n, 1));
  }

  /// Adds the proposed candidates that continue no neighbour. Duplicates only cost time, so that a small hash table,
  /// which misses some, will do. Only a candidate that continues a neighbour must not come back without its coherence
  /// factor.
  HWY_ATTR void add_proposed() {
    const auto hash = [](uint32_t id) { return (id * golden_ratio) >> (32 - recent_bits); };
    recent_.fill(no_id);
    uint64_t continued = 0;  // a bit for each two hashes of theirs: others need not be compared with them
    for (size_t c = 0; c < continued_; c++) {
      recent_[hash(ids_[c])] = ids_[c];
      if (coherence_may_cost_) continued |= uint64_t{1} << (hash(ids_[c]) / 2);
    }
    size_t count = count_;
    for (size_t i = 0; i < proposed_count_; i++) {
      const uint32_t id = proposed_[i], at = hash(id);
      bool is_new = recent_[at] != id;
      recent_[at] = id;
      if (continued >> (at / 2) & 1)
        for (size_t c = 0; c < continued_; c++) is_new &= ids_[c] != id;
      ids_[count] = id;
      count += is_new;
    }
    count_ = count;
    for (size_t i = count; i < count + 3; i++) ids_[i] = ids_[0];  // whoever reads four at once finds a position
  }

 private:
  static_assert(9 + 9 * most_similar + most_random_candidates + 3 <= most,
                "room for a pixel, its eight neighbours, their k-coherent candidates, and what four at once write");
  static constexpr int recent_bits = 7;
  static constexpr uint32_t golden_ratio = 0x9e3779b1;  // of 2^32: multiplicative hashing

  const CorrectionLevel& level_;
  size_t width_;
  bool coherence_may_cost_;
  uint32_t least_, most_, below_, beyond_;    // PaddedLevel::settle_inside, and what it makes of what lies outside
  std::array<uint32_t, 9> forth_{}, back_{};  // per neighbour: what leads from it to the pixel, in x and y
  ForEach<uint32_t> ids_, factors_, proposed_;
  size_t count_ = 0, continued_ = 0, proposed_count_ = 0;
  std::array<uint32_t, 1 << recent_bits> recent_;
};

}  // namespace HWY_NAMESPACE
}  // namespace terrazzo
HWY_AFTER_NAMESPACE();

#endif
