#include "core/synthesis/steps/element_holes.h"

#include <algorithm>
#include <tuple>

#include "core/numeric/distance_transform.h"

namespace terrazzo {

namespace {

/// The part of a tile in which something is missing: mostly little or nothing.
Rect unfilled_part(const std::vector<uint8_t>& filled, Size size, const Rect& tile) {
  int left = tile.right(), right = tile.x, top = tile.bottom(), bottom = tile.y;
  for (int y = tile.y; y < tile.bottom(); y++)
    for (int x = tile.x; x < tile.right(); x++)
      if (!filled[size_t(y) * size_t(size.width) + size_t(x)]) {
        left = std::min(left, x);
        right = std::max(right, x + 1);
        top = std::min(top, y);
        bottom = y + 1;
      }
  return left < right ? Rect{left, top, right - left, bottom - top} : Rect{};
}

}  // namespace

std::vector<Hole> find_holes(const std::vector<uint8_t>& filled, const Plane& plane, double least, int farthest) {
  const Size size = plane.size;
  if (std::ranges::find(filled, 1) == filled.end()) return {{size.width / 2, size.height / 2}};
  std::vector<Hole> out;
  constexpr int side = 256;
  for (int tile_y = 0; tile_y < size.height; tile_y += side)
    for (int tile_x = 0; tile_x < size.width; tile_x += side) {
      const Rect part = unfilled_part(filled, size, intersect({tile_x, tile_y, side, side}, whole(size)));
      if (part.empty()) continue;
      const Rect around = grown(part, farthest);
      const int left = plane.tile_x ? around.x : std::max(0, around.x);
      const int right = plane.tile_x ? around.right() : std::min(size.width, around.right());
      const int top = plane.tile_y ? around.y : std::max(0, around.y);
      const int bottom = plane.tile_y ? around.bottom() : std::min(size.height, around.bottom());
      std::vector<uint8_t> near;
      near.reserve(size_t(right - left) * size_t(bottom - top));
      for (int y = top; y < bottom; y++)
        for (int x = left; x < right; x++) near.push_back(filled[size_t(plane.index(x, y))]);
      const std::vector<int64_t> distance = squared_distances(near, {right - left, bottom - top}, false);
      for (int y = part.y; y < part.bottom(); y++)
        for (int x = part.x; x < part.right(); x++) {
          const int64_t d = distance[size_t(y - top) * size_t(right - left) + size_t(x - left)];
          if (double(d) > least * least) out.push_back({x, y, std::min(d, int64_t{farthest} * farthest)});
        }
    }
  std::ranges::sort(out, [](const Hole& a, const Hole& b) {
    return std::tuple(-a.squared, a.row, a.column) < std::tuple(-b.squared, b.row, b.column);
  });
  return out;
}

}  // namespace terrazzo
