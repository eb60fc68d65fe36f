#include "core/synthesis/pieces.h"

#include <algorithm>
#include <numeric>

namespace terrazzo {

namespace {

/// Disjoint sets of pixels, each named after its first (Tarjan 1975, with path halving).
class Joined {
 public:
  explicit Joined(size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0); }

  int root(int i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(int a, int b) {
    a = root(a);
    b = root(b);
    if (a != b) parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<int> parent_;
};

}  // namespace

Pieces::Pieces(const Field& field, const PaddedLevel& exemplar) {
  const Size size = field.size;
  const int count = int(size.area());
  const auto continues = [&](int from, int to, int dx, int dy) {
    int u = field.pixels[from].x + dx, v = field.pixels[from].y + dy;
    if (exemplar.wraps()) exemplar.settle(u, v);
    return u == field.pixels[to].x && v == field.pixels[to].y;
  };
  Joined joined(count);
  for (int y = 0; y < size.height; y++)
    for (int x = 0; x < size.width; x++) {
      const int i = y * size.width + x;
      if (x > 0 && continues(i - 1, i, 1, 0)) joined.join(i - 1, i);
      if (y > 0 && continues(i - size.width, i, 0, 1)) joined.join(i - size.width, i);
    }
  piece_.resize(count);
  std::vector<int> areas;
  for (int i = 0; i < count; i++) {
    const int first = joined.root(i);
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
