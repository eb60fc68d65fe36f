#include "runner/editor/previews/uv_piece.h"

#include <algorithm>
#include <cmath>

#include "core/base/error.h"

namespace terrazzo {

namespace {

constexpr int first_window = 256, greatest_window = 2048;

Rect window_around(Size all, int x, int y, int side) {
  const int width = std::min(all.width, side), height = std::min(all.height, side);
  return {std::clamp(x - width / 2, 0, all.width - width), std::clamp(y - height / 2, 0, all.height - height), width,
          height};
}

/// The piece inside of a window. Runs are in pixels of the whole map.
UvPiece piece_within(const Image& uv, Size exemplar, int x, int y, const Rect& window) {
  const auto channels = size_t(uv.channels());
  std::vector<float> values(size_t(window.area()) * channels);
  uv.read(window, values.data());
  const auto shift_at = [&](int i, int j) {
    const float* v = values.data() + (size_t(j) * window.width + i) * channels;
    return std::array{wrap(int(std::floor(v[0] * float(exemplar.width))) - (window.x + i), exemplar.width),
                      wrap(int(std::floor(v[1] * float(exemplar.height))) - (window.y + j), exemplar.height)};
  };
  UvPiece out{.shift = shift_at(x - window.x, y - window.y)};
  std::vector<bool> is_inside(size_t(window.area()));
  std::vector<std::array<int, 2>> open;
  const auto visit = [&](int i, int j) {
    if (i < 0 || j < 0 || i >= window.width || j >= window.height) return;
    const size_t at = size_t(j) * window.width + i;
    if (is_inside[at] || shift_at(i, j) != out.shift) return;
    is_inside[at] = true;
    open.push_back({i, j});
    out.is_whole &= (i > 0 || window.x == 0) && (j > 0 || window.y == 0) &&
                    (i + 1 < window.width || window.right() == uv.width()) &&
                    (j + 1 < window.height || window.bottom() == uv.height());
  };
  visit(x - window.x, y - window.y);
  while (!open.empty()) {
    const auto [i, j] = open.back();
    open.pop_back();
    visit(i - 1, j);
    visit(i + 1, j);
    visit(i, j - 1);
    visit(i, j + 1);
  }
  for (int j = 0; j < window.height; j++)
    for (int i = 0; i < window.width; i++) {
      if (!is_inside[size_t(j) * window.width + i]) continue;
      const int begin = i;
      while (i < window.width && is_inside[size_t(j) * window.width + i]) i++;
      out.runs.push_back({window.y + j, window.x + begin, window.x + i});
      out.area += i - begin;
    }
  return out;
}

}  // namespace

UvPiece uv_piece_at(const Image& uv, Size exemplar, int x, int y) {
  if (uv.channels() < 2 || exemplar.width < 1 || exemplar.height < 1) throw Error("expected a uv map");
  for (int side = first_window;; side = std::min(2 * side, greatest_window)) {
    UvPiece piece = piece_within(uv, exemplar, x, y, window_around(uv.size(), x, y, side));
    if (piece.is_whole || side == greatest_window) return piece;
  }
}

}  // namespace terrazzo
