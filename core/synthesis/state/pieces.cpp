#include "core/synthesis/state/pieces.h"

#include <numeric>

#include "core/base/disjoint_sets.h"

namespace terrazzo {

Pieces::Pieces(const Field& field, int block, bool wraps_x, bool wraps_y) {
  const Size size = field.size;
  const int count = int(size.area());
  DisjointSets joined{size_t(count)};
  const auto join_if_continued = [&](int from, int to, int dx, int dy) {
    const ExemplarPixel p = field.pixels[from], q = field.pixels[to];
    if (p.x + dx == q.x && p.y + dy == q.y) joined.join(uint32_t(from), uint32_t(to));
  };
  for (int y = 0; y < size.height; y++)
    for (int x = 0; x < size.width; x++) {
      const int i = y * size.width + x;
      if (x > 0 || wraps_x) join_if_continued(x > 0 ? i - 1 : i + size.width - 1, i, block, 0);
      if (y > 0 || wraps_y) join_if_continued(y > 0 ? i - size.width : i + count - size.width, i, 0, block);
    }
  piece_.resize(count);
  std::vector<int> areas;
  for (int i = 0; i < count; i++) {
    const int first = int(joined.find(uint32_t(i)));
    if (first == i) {
      piece_[i] = int(areas.size());
      areas.push_back(0);
    } else {
      piece_[i] = piece_[first];
    }
    areas[piece_[i]]++;
  }
  begin_.assign(areas.size() + 1, 0);
  std::partial_sum(areas.begin(), areas.end(), begin_.begin() + 1);
  std::vector<int> next(begin_.begin(), begin_.end() - 1);
  members_.resize(count);
  for (int i = 0; i < count; i++) members_[next[piece_[i]]++] = i;
}

}  // namespace terrazzo
