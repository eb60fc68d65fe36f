#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "core/exemplar/uv_map.h"

namespace terrazzo {

/// The offset from an output pixel to the exemplar pixel it shows, in pixels of the resolved exemplar.
struct Offset {
  int x = 0;
  int y = 0;
  bool operator==(const Offset&) const = default;
};

/// A uv map at the resolution of an exemplar that may be larger than the analysed one. Immutable; thread-safe.
class FineLayout {
 public:
  /// `exemplar`: size of the resolved exemplar, at least the analysed one's. `radius`: of blending, in pixels of the uv
  /// map.
  FineLayout(UvMapPtr uv, Size exemplar, double radius);

  /// Size of the output: the uv map's, times exemplar size over analysed size.
  Size size() const { return size_of(uv_->size(), uv_->exemplar(), exemplar_); }
  static Size size_of(Size uv, Size analysed, Size exemplar) {
    return {Scale{exemplar.width, analysed.width}.length(uv.width),
            Scale{exemplar.height, analysed.height}.length(uv.height)};
  }
  Size exemplar() const { return exemplar_; }
  double radius() const { return radius_; }
  /// The number of uv map pixels on each side that a fine pixel depends on.
  int reach() const { return reach_; }
  const UvMap& uv() const { return *uv_; }

  /// The pixel of the uv map that a fine pixel lies in.
  int owner_x(int x) const { return std::min(x_.coarse(x), uv_->size().width - 1); }
  int owner_y(int y) const { return std::min(y_.coarse(y), uv_->size().height - 1); }
  /// From the centre of a uv map pixel (which may lie outside) to that of a fine pixel, in pixels of the uv map.
  double distance_x(int owner, int x) const { return x_.centre(x) - (owner + 0.5); }
  double distance_y(int owner, int y) const { return y_.centre(y) - (owner + 0.5); }

  /// The offsets of `count` pixels of row `y` of the uv map, from column `left` on; both may lie outside. Wraps if the
  /// output does; else the pieces at the border continue.
  void offsets(int left, int y, int count, Offset* out) const;

  /// The exemplar pixels shown by part of an output row, which must lie inside.
  void shown(int x, int y, int count, Offset* out) const;

  /// Wraps exemplar coordinates reached by an offset; false if they lie outside.
  bool inside(int& x, int& y) const;
  /// The same for a pixel's own offset, which rounding may move one fine pixel outside; clamps it.
  void settle(int& x, int& y) const;

 private:
  /// Fine pixels per coarse pixel along one axis, as a fraction.
  struct Scale {
    int64_t to = 1, from = 1;
    int length(int coarse) const { return int((2 * coarse * to + from) / (2 * from)); }
    int coarse(int fine) const { return int((2 * int64_t{fine} + 1) * from / (2 * to)); }
    double centre(int fine) const { return (fine + 0.5) * double(from) / double(to); }
    int offset(int coarse) const;
    double overhang() const { return to % from == 0 ? 0.5 - 0.5 * double(from) / double(to) : 0.5; }
  };

  UvMapPtr uv_;
  Size exemplar_;
  double radius_;
  Scale x_, y_;
  int reach_;
};

/// The offsets around a region of the output, with a mask of pixels far from seams. Not thread-safe.
class LayoutWindow {
 public:
  LayoutWindow(const FineLayout& layout, const Rect& region);

  /// The offset of a uv map pixel, up to `reach` beyond the owners of the region's pixels.
  const Offset& at(int owner_x, int owner_y) const {
    return offsets_[size_t(owner_y - around_.y) * around_.width + size_t(owner_x - around_.x)];
  }
  /// Whether all offsets within reach of that pixel are equal: no seam is near.
  bool calm(int owner_x, int owner_y) const {
    return calm_.empty() || calm_[size_t(owner_y - owners_.y) * owners_.width + size_t(owner_x - owners_.x)] != 0;
  }

 private:
  void find_calm(int reach);

  Rect owners_, around_;
  std::vector<Offset> offsets_;
  std::vector<uint8_t> calm_;  ///< empty if reach is 0: there are no seams then
};

}  // namespace terrazzo
