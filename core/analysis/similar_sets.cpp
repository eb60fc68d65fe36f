#include "core/analysis/similar_sets.h"

#include <array>
#include <limits>

#include <tbb/parallel_for.h>

#include "core/analysis/padded_level.h"

namespace terrazzo {

namespace {

constexpr int64_t exhaustive_area = 1600;
constexpr int rounds = 5;
constexpr int apart = 3;  // pixels between members of a set, in x or y

constexpr int none = std::numeric_limits<int>::max();

struct Found {
  int distance = none;
  int x = 0;
  int y = 0;
};
using Set = std::array<Found, most_similar>;

class LevelSearch {
 public:
  LevelSearch(const AppearanceLevel& level, bool wraps, int per_pixel, const LatticePhase& phase)
      : level_(level, wraps),
        phase_(phase),
        per_pixel_(per_pixel),
        away_(std::max(3, std::min(level.size.width, level.size.height) / 20)) {}

  Size size() const { return level_.size(); }
  std::array<int, 2> place(uint64_t bits) const { return level_.place(bits); }

  /// Distance of the surroundings: nine vectors, two pixels apart, which together see 9x9 pixels.
  int distance(int x, int y, int u, int v, int limit) const {
    int sum = 0;
    for (int j = -2; j <= 2; j += 2) {
      for (int i = -2; i <= 2; i += 2) sum += squared_distance(*level_.at(x + i, y + j), *level_.at(u + i, v + j));
      if (sum >= limit) break;
    }
    return sum;
  }

  /// Offers (u, v), or of a regular exemplar the place in phase that is nearest to it.
  void offer_near(Set& set, int x, int y, int u, int v) const {
    phase_.snap(x, y, u, v);
    offer(set, x, y, u, v);
  }

  /// Puts (u, v) into the set of (x, y) if it belongs there.
  void offer(Set& set, int x, int y, int u, int v) const {
    level_.settle(u, v);
    if (phase_.resolves_cells() && phase_.penalty(u, v, x, y) > 1) return;
    if (between(x, u, size().width) < away_ && between(y, v, size().height) < away_) return;
    // A newcomer may take the place of one member that is too near to it, if it is better; between two it has no place.
    int limit = set[per_pixel_ - 1].distance, near = -1;
    for (int k = 0; k < per_pixel_ && set[k].distance != none; k++) {
      if (between(set[k].x, u, size().width) >= apart || between(set[k].y, v, size().height) >= apart) continue;
      if (near >= 0) return;
      near = k;
      limit = set[k].distance;
    }
    const int d = distance(x, y, u, v, limit);
    if (d >= limit) return;
    int k = near >= 0 ? near : per_pixel_ - 1;
    for (; k > 0 && set[k - 1].distance > d; k--) set[k] = set[k - 1];
    set[k] = {d, u, v};
  }

 private:
  int between(int a, int b, int n) const {
    const int d = std::abs(a - b);
    return level_.wraps() ? std::min(d, n - d) : d;
  }
  PaddedLevel level_;
  LatticePhase phase_;
  int per_pixel_;
  int away_;
};

using Sets = std::vector<Set>;

template <typename Fill>
void for_each_pixel(Size size, const Task& task, const Fill& fill) {
  tbb::parallel_for(0, size.height, [&](int y) {
    task.check();
    for (int x = 0; x < size.width; x++) fill(x, y);
  });
}

Sets search_all(const LevelSearch& level, const Task& task) {
  const Size size = level.size();
  Sets sets(size_t(size.area()));
  for_each_pixel(size, task, [&](int x, int y) {
    Set& set = sets[size_t(y) * size.width + x];
    for (int v = 0; v < size.height; v++)
      for (int u = 0; u < size.width; u++) level.offer(set, x, y, u, v);
  });
  return sets;
}

/// Starts from the parents' sets, if there is a coarser level, and from random places.
Sets started(const LevelSearch& level, int per_pixel, const Sets& parent, Size parent_size, const Task& task) {
  const Size size = level.size();
  Sets sets(size_t(size.area()));
  for_each_pixel(size, task, [&](int x, int y) {
    Set& set = sets[size_t(y) * size.width + x];
    if (!parent.empty()) {
      const Set& from = parent[size_t(y / 2) * parent_size.width + x / 2];
      for (int k = 0; k < per_pixel; k++) level.offer_near(set, x, y, 2 * from[k].x + (x & 1), 2 * from[k].y + (y & 1));
    }
    const int random_places = parent.empty() ? 8 * per_pixel : per_pixel;
    for (int k = 0; k < random_places; k++) {
      const uint64_t r = random_bits(1, x, y, k);
      const auto [u, v] = level.place(r);
      level.offer_near(set, x, y, u, v);
    }
  });
  return sets;
}

/// One round: every pixel looks at what its neighbours found in the round before, and at random around its own finds.
Sets improved(const LevelSearch& level, int per_pixel, const Sets& before, int round, const Task& task) {
  const Size size = level.size();
  Sets sets = before;
  constexpr int dx[4] = {-1, 1, 0, 0}, dy[4] = {0, 0, -1, 1};
  for_each_pixel(size, task, [&](int x, int y) {
    Set& set = sets[size_t(y) * size.width + x];
    const Set own = set;
    for (int n = 0; n < 4; n++) {
      const int nx = x + dx[n], ny = y + dy[n];
      if (nx < 0 || ny < 0 || nx >= size.width || ny >= size.height) continue;
      const Set& other = before[size_t(ny) * size.width + nx];
      for (int k = 0; k < per_pixel; k++) level.offer(set, x, y, other[k].x - dx[n], other[k].y - dy[n]);
    }
    for (int k = 0; k < per_pixel; k++) {
      const int reach = std::max(2, std::max(size.width, size.height) >> (2 * round + 2 + k % 2));
      const uint64_t r = random_bits(2, x, y, k, round);
      level.offer_near(set, x, y, own[k].x + int(below(uint32_t(r), 2 * reach + 1)) - reach,
                       own[k].y + int(below(uint32_t(r >> 32), 2 * reach + 1)) - reach);
    }
  });
  return sets;
}

SimilarSets packed(const Sets& sets, Size size, int per_pixel) {
  SimilarSets out{per_pixel, {}};
  out.positions.reserve(sets.size() * per_pixel);
  for (size_t i = 0; i < sets.size(); i++)
    for (int k = 0; k < per_pixel; k++) {
      const Found& f = sets[i][k];
      // Too small an exemplar may not have enough places apart: the pixel itself then fills the set.
      out.positions.push_back(f.distance == none ? uint32_t(i) : uint32_t(f.y * size.width + f.x));
    }
  return out;
}

}  // namespace

IndexPtr make_index(const AppearancePtr& appearance, int per_pixel, const Task& task) {
  const std::vector<AppearanceLevel>& levels = appearance->levels();
  std::vector<SimilarSets> out(levels.size());
  Sets sets;
  Size parent_size;
  for (int l = int(levels.size()) - 1; l >= 0; l--) {
    const LevelSearch level(levels[l], appearance->wraps(), per_pixel,
                            LatticePhase(appearance->lattice(), l, appearance->size(), false, false));
    if (level.size().area() <= exhaustive_area) {
      sets = search_all(level, task);
    } else {
      sets = started(level, per_pixel, sets, parent_size, task);
      for (int round = 0; round < rounds; round++) sets = improved(level, per_pixel, sets, round, task);
    }
    parent_size = level.size();
    out[l] = packed(sets, parent_size, per_pixel);
    task.progress(1.0 / double(int64_t{1} << (2 * l)));
  }
  return Index::make(appearance, std::move(out));
}

}  // namespace terrazzo
