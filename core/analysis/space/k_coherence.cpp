#include "core/analysis/space/k_coherence.h"

#include <algorithm>
#include <limits>
#include <span>

#include <tbb/parallel_for.h>

#include "core/analysis/space/padded_level.h"
#include "core/base/tuning.h"

namespace terrazzo {

namespace {

struct KCoherenceTuning {
  int exhaustive_area = 1600;
  int rounds = 4;
  int searched_side = 128;
  int apart = 3;
  int finest_searched = 1;
  int tile_side = 32;
  int least_away = 3;
  int away = 20;
  int tries = 8;
};
const Tunable<KCoherenceTuning> k_coherence_tuning(
    "k_coherence",
    {
        {&KCoherenceTuning::exhaustive_area, "exhaustive_area", "pixels of a level",
         "up to which all places are compared. Higher: the most similar are found for certain; costs "
         "time, with its square",
         "not measured: bounds the time"},
        {&KCoherenceTuning::rounds, "rounds", "rounds",
         "of the search. Higher: more similar pixels are found; costs time", "k_coherence", 0, 14},
        {&KCoherenceTuning::searched_side, "searched_side", "pixels",
         "of a level, within which one with a coarser one looks for new places. Higher: it looks "
         "farther, where its parent has done that; lower: less time",
         "k_coherence"},
        {&KCoherenceTuning::apart, "apart", "pixels in x or y",
         "between members of a set. Higher: more different candidates; lower: more similar ones", "k_coherence"},
        {&KCoherenceTuning::finest_searched, "finest_searched", "level",
         "lower: the finest level has similar pixels, too, which brings nothing, as only seams still "
         "move there; costs time and memory. Higher: seams of regular exemplars break",
         "k_coherence"},
        {&KCoherenceTuning::tile_side, "tile_side", "pixels",
         "that one thread goes through in order. Higher: what neighbours found gets farther; lower: "
         "more threads have work",
         "k_coherence", 1},
        {&KCoherenceTuning::least_away, "least_away", "pixels in x or y",
         "of a pixel, within which all is too similar to be of use. Higher: more different candidates; "
         "lower: tiny exemplars have more",
         "k_coherence"},
        {&KCoherenceTuning::away, "away", "parts of the shorter side",
         "the same. Higher: nearer candidates; lower: more different ones", "k_coherence", 1},
        {&KCoherenceTuning::tries, "tries", "random places for each member",
         "that a set is begun with. Higher: sets are full; costs time", "k_coherence"},
    });

constexpr uint32_t none = std::numeric_limits<uint32_t>::max();

struct NearPixel {
  uint32_t distance = none;
  uint16_t x = 0;
  uint16_t y = 0;
};
using Set = std::span<NearPixel>;  // best first

bool is_full(Set set) {
  return set.back().distance != none;
}

/// The sets of all pixels of a level.
struct Sets {
  Size size;
  int per_pixel = 0;
  std::vector<NearPixel> found;

  Sets() = default;
  Sets(Size s, int count) : size(s), per_pixel(count), found(size_t(s.area()) * count) {}
  Set at(int x, int y) { return {&found[(size_t(y) * size.width + x) * per_pixel], size_t(per_pixel)}; }
};

constexpr int no_period = 1 << 30;

/// Squared distance of three vectors, two pixels apart. Written such that the compiler adds up their vectors of squares
/// before it adds those up.
uint32_t row_distance(const AppearanceVector* a, const AppearanceVector* b) {
  std::array<int16_t, 3 * appearance_dimensions> differences;
  for (int k = 0; k < 3; k++)
    for (int d = 0; d < appearance_dimensions; d++)
      differences[k * appearance_dimensions + d] = int16_t(a[2 * k - 2][d] - b[2 * k - 2][d]);
  int sum = 0;
  for (const int16_t difference : differences) sum += difference * difference;
  return uint32_t(sum);
}

class LevelSearch {
 public:
  LevelSearch(const AppearanceLevel& level, bool wraps, const PartPhases& phase)
      : level_(level, wraps),
        phase_(phase),
        period_x_(wraps ? level.size.width : no_period),
        period_y_(wraps ? level.size.height : no_period),
        away_(std::max(k_coherence_tuning->least_away,
                       std::min(level.size.width, level.size.height) / k_coherence_tuning->away)),
        apart_(k_coherence_tuning->apart) {}

  Size size() const { return level_.size(); }
  std::array<int, 2> place(uint64_t bits) const { return level_.place(bits); }

  /// (u, v) where it is usable, of a regular exemplar the place in phase with (x, y) that is nearest to it.
  std::array<int, 2> settled(int x, int y, int u, int v) const {
    const Vector2d shown = phase_.shown_at(x, y);
    phase_.snap(shown.x(), shown.y(), u, v);
    level_.settle(u, v);
    return {u, v};
  }
  void prefetch(const std::array<int, 2>& place) const {
    for (int j = -2; j <= 2; j += 2)
      for (int i = -2; i <= 2; i += 4) __builtin_prefetch(level_.at(place[0] + i, place[1] + j));
  }

  /// Offers a place that may lie outside the level.
  void offer_shifted(Set set, int x, int y, int u, int v) const {
    level_.settle(u, v);
    offer(set, x, y, u, v);
  }

  /// Puts (u, v) into the set of (x, y) if it belongs there.
  void offer(Set set, int x, int y, int u, int v) const {
    // A newcomer may take the place of one member that is too near to it, if it is better; between two it has no place.
    size_t place = set.size() - 1;
    uint32_t limit = set[place].distance;
    int near = 0;
    bool is_member = false;
    for (size_t k = 0; k < set.size(); k++) {
      const NearPixel f = set[k];
      const int apart_x = between(f.x, u, period_x_), apart_y = between(f.y, v, period_y_);
      const bool is_near = (apart_x < apart_) & (apart_y < apart_) & (f.distance != none);
      is_member |= is_near & (apart_x + apart_y == 0);
      near += is_near;
      place = is_near ? k : place;
      limit = is_near ? f.distance : limit;
    }
    if (is_member | (near > 1)) return;
    if (between(x, u, period_x_) < away_ && between(y, v, period_y_) < away_) return;
    if (phase_.resolves_cells() && is_out_of_phase(u, v, x, y)) return;
    const uint32_t d = distance(x, y, u, v, limit);
    if (d >= limit) return;
    for (; place > 0 && set[place - 1].distance > d; place--) set[place] = set[place - 1];
    set[place] = {d, uint16_t(u), uint16_t(v)};
  }

  /// Distance of the surroundings: nine vectors, two pixels apart, which together see 9x9 pixels. Gives up, with a
  /// part of it, once that reaches the limit.
  uint32_t distance(int x, int y, int u, int v, uint32_t limit) const {
    const AppearanceVector *a = level_.at(x, y), *b = level_.at(u, v);
    const ptrdiff_t rows = 2 * level_.stride();
    uint32_t sum = row_distance(a, b);
    if (sum < limit) sum += row_distance(a - rows, b - rows);
    if (sum < limit) sum += row_distance(a + rows, b + rows);
    return sum;
  }

 private:
  bool is_out_of_phase(int u, int v, int x, int y) const {
    const Vector2d shown = phase_.shown_at(x, y);
    return phase_.penalty(u, v, shown.x(), shown.y()) > 1;
  }
  static int between(int a, int b, int period) {
    const int d = std::abs(a - b);
    return std::min(d, period - d);
  }
  PaddedLevel level_;
  PartPhases phase_;
  int period_x_, period_y_;
  int away_, apart_;
};

void search_all(const LevelSearch& level, Sets& sets, const Task& task) {
  const Size size = level.size();
  tbb::parallel_for(0, size.height, [&](int y) {
    task.check();
    for (int x = 0; x < size.width; x++) {
      const Set set = sets.at(x, y);
      for (int v = 0; v < size.height; v++)
        for (int u = 0; u < size.width; u++)
          if (level.distance(x, y, u, v, set.back().distance) < set.back().distance)
            level.offer_shifted(set, x, y, u, v);
    }
  });
}

/// Starts from the parents' sets, or where there is no coarser level, or they do not fill a set, from random places.
void start(const LevelSearch& level, Sets& sets, Sets& parent, const Task& task) {
  const bool has_parent = !parent.found.empty();
  tbb::parallel_for(0, sets.size.height, [&](int y) {
    task.check();
    for (int x = 0; x < sets.size.width; x++) {
      const Set set = sets.at(x, y);
      const auto offer = [&](const std::array<int, 2>& place) { level.offer(set, x, y, place[0], place[1]); };
      if (has_parent)
        for (const NearPixel& f : parent.at(x / 2, y / 2))
          offer(level.settled(x, y, 2 * f.x + (x & 1), 2 * f.y + (y & 1)));
      for (int k = 0; k < k_coherence_tuning->tries * sets.per_pixel && !(has_parent && is_full(set)); k++) {
        const auto [u, v] = level.place(random_bits(1, x, y, k));
        offer(level.settled(x, y, u, v));
      }
    }
  });
}

/// Every pixel of a tile looks at what two of its neighbours have found, and at random around its own finds.
void improve_tile(const LevelSearch& level, Sets& sets, const Rect& tile, int round, int widest) {
  const Size size = sets.size;
  const int step = round % 2 == 0 ? 1 : -1;
  std::array<std::array<int, 2>, most_similar> at_random;
  for (int j = 0; j < tile.height; j++)
    for (int i = 0; i < tile.width; i++) {
      const int x = step > 0 ? tile.x + i : tile.right() - 1 - i, y = step > 0 ? tile.y + j : tile.bottom() - 1 - j;
      const Set set = sets.at(x, y);
      for (int k = 0; k < sets.per_pixel; k++) {
        const int reach = std::max(2, widest >> (2 * round + 2 + k % 2));
        const uint64_t r = random_bits(2, x, y, k, round);
        at_random[k] = level.settled(x, y, set[k].x + int(below(uint32_t(r), 2 * reach + 1)) - reach,
                                     set[k].y + int(below(uint32_t(r >> 32), 2 * reach + 1)) - reach);
        level.prefetch(at_random[k]);
      }
      const auto look_at = [&](int dx, int dy) {
        const int nx = x - dx, ny = y - dy;
        if (nx < 0 || ny < 0 || nx >= size.width || ny >= size.height) return;
        for (const NearPixel& f : sets.at(nx, ny)) level.offer_shifted(set, x, y, f.x + dx, f.y + dy);
      };
      look_at(step, 0);
      look_at(0, step);
      for (int k = 0; k < sets.per_pixel; k++) level.offer(set, x, y, at_random[k][0], at_random[k][1]);
    }
}

/// One round over all tiles, those of one colour of a chequerboard after those of the other: a tile's neighbours stand
/// still while it is gone through.
void improve(const LevelSearch& level, Sets& sets, int round, int widest, const Task& task) {
  const int tile_side = k_coherence_tuning->tile_side;
  const int columns = (sets.size.width + tile_side - 1) / tile_side,
            rows = (sets.size.height + tile_side - 1) / tile_side;
  for (int colour = 0; colour < 2; colour++)
    tbb::parallel_for(0, rows * columns, [&](int i) {
      const int column = i % columns, row = i / columns;
      if ((column + row) % 2 != colour) return;
      task.check();
      improve_tile(level, sets,
                   intersect(whole(sets.size), {column * tile_side, row * tile_side, tile_side, tile_side}), round,
                   widest);
    });
}

SimilarSets packed(const Sets& sets) {
  SimilarSets out{sets.per_pixel, {}};
  out.positions.reserve(sets.found.size());
  for (size_t i = 0; i < sets.found.size(); i++) {
    const NearPixel& f = sets.found[i];
    // Too small an exemplar may not have enough places apart: the pixel itself then fills the set.
    out.positions.push_back(f.distance == none ? uint32_t(i / sets.per_pixel)
                                               : uint32_t(f.y) * uint32_t(sets.size.width) + f.x);
  }
  return out;
}

}  // namespace

IndexPtr make_index(const AppearancePtr& appearance, int per_pixel, const Task& task) {
  const std::vector<AppearanceLevel>& levels = appearance->levels();
  std::vector<SimilarSets> out(levels.size());
  Sets parent;
  for (int l = int(levels.size()) - 1; l >= std::min(k_coherence_tuning->finest_searched, int(levels.size()) - 1);
       l--) {
    const LevelSearch level(levels[l], appearance->wraps(),
                            PartPhases(appearance->repeats(), levels[l].size, l, {appearance->levels().front().size}));
    Sets sets(level.size(), per_pixel);
    if (level.size().area() <= k_coherence_tuning->exhaustive_area) {
      search_all(level, sets, task);
    } else {
      start(level, sets, parent, task);
      const int longest = std::max(sets.size.width, sets.size.height);
      const int widest = parent.found.empty() ? longest : std::min(longest, k_coherence_tuning->searched_side);
      for (int round = 0; round < k_coherence_tuning->rounds; round++) improve(level, sets, round, widest, task);
    }
    out[l] = packed(sets);
    parent = std::move(sets);
    task.progress(1.0 / double(int64_t{1} << (2 * l)));
  }
  return Index::make(appearance, std::move(out));
}

}  // namespace terrazzo
