#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "core/exemplar/uv_map.h"

namespace terrazzo {

/// From an output pixel to the exemplar pixel it shows, in pixels of the exemplar that is resolved.
struct Offset {
  int x = 0;
  int y = 0;
  bool operator==(const Offset&) const = default;
};

/// A uv map seen at the resolution of an exemplar that may be larger than the analysed one. Immutable, so thread-safe.
class FineLayout {
 public:
  /// `exemplar`: the size that is resolved, at least the analysed one. `radius` of the neighbours that matter, in
  /// pixels of the uv map.
  FineLayout(UvMapPtr uv, Size exemplar, double radius);

  /// Of the output: the uv map's times that of the exemplar over the analysed one.
  Size size() const { return {x_.length(uv_->size().width), y_.length(uv_->size().height)}; }
  Size exemplar() const { return exemplar_; }
  double radius() const { return radius_; }
  /// How many pixels of the uv map beyond its own one a fine pixel may see in each direction.
  int reach() const { return reach_; }
  const UvMap& uv() const { return *uv_; }

  /// The pixel of the uv map that a fine pixel lies in.
  int owner_x(int x) const { return std::min(x_.coarse(x), uv_->size().width - 1); }
  int owner_y(int y) const { return std::min(y_.coarse(y), uv_->size().height - 1); }
  /// From the centre of a pixel of the uv map (which may lie outside it) to that of a fine pixel, in pixels of the uv
  /// map.
  double distance_x(int owner, int x) const { return x_.centre(x) - (owner + 0.5); }
  double distance_y(int owner, int y) const { return y_.centre(y) - (owner + 0.5); }

  /// The offsets that a row of the uv map proposes, from column `left` on. Beyond a border the other side follows if
  /// the output wraps, else the border pixels' pieces go on.
  void offsets(int left, int y, int count, Offset* out) const;

  /// The exemplar pixels that part of a row of the output shows. The part lies inside.
  void shown(int x, int y, int count, Offset* out) const;

  /// The exemplar pixel at coordinates that an offset led to: around the other side if it wraps; false if they lie
  /// outside.
  bool inside(int& x, int& y) const;
  /// The same for a pixel's own proposal, which rounding may move one fine pixel over the border.
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

/// The offsets around a region of the output, and where no seam is near. Belongs to one thread.
class LayoutWindow {
 public:
  LayoutWindow(const FineLayout& layout, const Rect& region);

  /// The proposal of a pixel of the uv map, up to `reach` beyond those that own the region's pixels.
  const Offset& at(int owner_x, int owner_y) const {
    return offsets_[size_t(owner_y - around_.y) * around_.width + size_t(owner_x - around_.x)];
  }
  /// Whether all proposals within reach of that pixel's fine pixels are the same.
  bool calm(int owner_x, int owner_y) const {
    return calm_.empty() || calm_[size_t(owner_y - owners_.y) * owners_.width + size_t(owner_x - owners_.x)] != 0;
  }

 private:
  void find_calm(int reach);

  Rect owners_, around_;
  std::vector<Offset> offsets_;
  std::vector<uint8_t> calm_;  ///< empty if reach is 0: a pixel alone has no seam
};

}  // namespace terrazzo
