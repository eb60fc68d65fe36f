#pragma once

#include <algorithm>
#include <cstdint>
#include <string>

namespace terrazzo {

/// Width and height in pixels.
struct Size {
  int width = 0;
  int height = 0;
  int64_t area() const { return int64_t{width} * height; }
  bool operator==(const Size&) const = default;
};

/// "256x128"
std::string describe(Size size);

/// Whether the sizes have the same aspect ratio, up to rounding to whole pixels.
bool same_shape(Size a, Size b);

/// A rectangle of pixels; (x, y) is its top left corner, y grows downwards.
struct Rect {
  int x = 0;
  int y = 0;
  int width = 0;
  int height = 0;
  int64_t area() const { return int64_t{width} * height; }
  int right() const { return x + width; }
  int bottom() const { return y + height; }
  bool empty() const { return width <= 0 || height <= 0; }
  bool operator==(const Rect&) const = default;
};

inline Rect whole(Size size) {
  return {0, 0, size.width, size.height};
}

inline Rect intersect(const Rect& a, const Rect& b) {
  const int x = std::max(a.x, b.x), y = std::max(a.y, b.y);
  return {x, y, std::max(0, std::min(a.right(), b.right()) - x), std::max(0, std::min(a.bottom(), b.bottom()) - y)};
}

inline bool contains(const Rect& r, int x, int y) {
  return x >= r.x && y >= r.y && x < r.right() && y < r.bottom();
}

/// The smallest rectangle around both, neither of which may be empty.
inline Rect united(const Rect& a, const Rect& b) {
  const int x = std::min(a.x, b.x), y = std::min(a.y, b.y);
  return {x, y, std::max(a.right(), b.right()) - x, std::max(a.bottom(), b.bottom()) - y};
}

inline Rect grown(const Rect& r, int by) {
  return {r.x - by, r.y - by, r.width + 2 * by, r.height + 2 * by};
}

/// The mathematical modulus: the result is in [0, n).
inline int wrap(int v, int n) {
  const int m = v % n;
  return m < 0 ? m + n : m;
}

}  // namespace terrazzo
