#pragma once

#include <array>
#include <vector>

#include "core/exemplar/appearance.h"

namespace terrazzo {

/// One appearance level with a margin around it, so that windows need no bounds checks. Around an exemplar that tiles
/// lies its other side, around others what they show mirrored about their outermost pixels: that seldom matches, so
/// that pieces end at the border instead of being smeared beyond it. Immutable; thread-safe.
class PaddedLevel {
 public:
  static constexpr int margin = 4;
  PaddedLevel(const AppearanceLevel& level, bool wraps);

  Size size() const { return size_; }
  int stride() const { return stride_; }
  bool wraps() const { return wraps_; }
  /// Valid for coordinates up to `margin` outside the level.
  const AppearanceVector* at(int x, int y) const {
    return &vectors_[size_t(y + margin) * stride_ + size_t(x + margin)];
  }
  /// Whether only some pixels are usable.
  bool masked() const { return masked_; }
  /// Brings a position to where a window fits: around the border of an exemplar that tiles, at least `keep_off()`
  /// pixels inside that of others.
  [[gnu::always_inline]] void settle_inside(int& x, int& y) const {
    if (wraps_) return unwind(x, y);
    x = within(x, keep_off_, size_.width - 1 - keep_off_);
    y = within(y, keep_off_, size_.height - 1 - keep_off_);
  }
  /// Wraps a position into an exemplar that tiles; does nothing for others.
  void unwind(int& x, int& y) const {
    if (!wraps_) return;
    if (x < 0 || x >= size_.width) x = wrap(x, size_.width);
    if (y < 0 || y >= size_.height) y = wrap(y, size_.height);
  }
  /// As settle_inside, then to the nearest usable pixel.
  void settle(int& x, int& y) const {
    settle_inside(x, y);
    if (masked_) settle_usable(x, y);
  }
  /// Whether synthesis may use a position inside the level.
  bool is_usable(int x, int y) const {
    const size_t at = size_t(y) * size_.width + x;
    return !masked_ || nearest_usable_[at] == at;
  }
  /// Whether a position, which may lie outside, is usable without being moved.
  bool holds(int x, int y) const {
    int u = x, v = y;
    settle_inside(u, v);
    return u == x && v == y && is_usable(x, y);
  }
  /// A usable position for 64 random bits, all equally likely.
  std::array<int, 2> place(uint64_t bits) const {
    if (masked_) return usable_place(bits);
    return {int(below(uint32_t(bits), size_.width)), int(below(uint32_t(bits >> 32), size_.height))};
  }
  /// Least distance of positions from the border, in pixels: 0 if the exemplar tiles. Nearer windows see the margin;
  /// coarse levels accept one row of it, to lose less of the exemplar.
  int keep_off() const { return keep_off_; }

 private:
  // As std::clamp, but by value: references may go through memory.
  [[gnu::always_inline]] static int within(int v, int least, int most) {
    const int raised = v < least ? least : v;
    return raised > most ? most : raised;
  }
  void settle_usable(int& x, int& y) const;
  std::array<int, 2> usable_place(uint64_t bits) const;

  Size size_;
  bool wraps_;
  int keep_off_;
  bool masked_;
  int stride_;
  std::vector<AppearanceVector> vectors_;
  std::vector<uint32_t> usable_;          // positions y * width + x; both are empty if all pixels are usable
  std::vector<uint32_t> nearest_usable_;  // for every pixel
};

/// Squared distance of two appearance vectors. Vectorised by the compiler, as differences fit 16 bits, unless it
/// unrolls the loop first, as it does within other loops.
inline int squared_distance(const AppearanceVector& a, const AppearanceVector& b) {
  int sum = 0;
#pragma GCC unroll 1
  for (int d = 0; d < appearance_dimensions; d++) {
    const auto difference = int16_t(a[d] - b[d]);
    sum += difference * difference;
  }
  return sum;
}

}  // namespace terrazzo
