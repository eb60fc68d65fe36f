#include "core/numeric/watershed.h"

#include <algorithm>
#include <array>
#include <queue>
#include <span>
#include <tuple>
#include <utility>

#include "core/base/disjoint_sets.h"

namespace terrazzo {

namespace {

/// Calls `visit` with the position of each of a pixel's four neighbours that exist.
template <typename Visit>
void for_neighbours(uint32_t at, Size size, bool wraps, Visit visit) {
  const auto w = uint32_t(size.width), h = uint32_t(size.height);
  const uint32_t x = at % w, y = at / w;
  if (x > 0 || wraps) visit(x > 0 ? at - 1 : at + w - 1);
  if (x + 1 < w || wraps) visit(x + 1 < w ? at + 1 : at + 1 - w);
  if (y > 0 || wraps) visit(y > 0 ? at - w : at + w * (h - 1));
  if (y + 1 < h || wraps) visit(y + 1 < h ? at + w : at - w * (h - 1));
}

/// Calls `visit` for each pair of adjacent pixels of different regions, with the regions, the lower first, and the
/// pixels.
template <typename Visit>
void for_pairs(const Regions& regions, Size size, bool wraps, Visit visit) {
  const auto compare = [&](uint32_t p, uint32_t q) {
    const uint32_t a = regions.at[p], b = regions.at[q];
    if (a != b) visit(std::min(a, b), std::max(a, b), p, q);
  };
  const auto w = uint32_t(size.width), h = uint32_t(size.height);
  for (uint32_t y = 0; y < h; y++) {
    const uint32_t row = y * w, below = y + 1 < h ? row + w : 0;
    for (uint32_t x = 0; x + 1 < w; x++) compare(row + x, row + x + 1);
    if (wraps) compare(row + w - 1, row);
    if (y + 1 < h || wraps)
      for (uint32_t x = 0; x < w; x++) compare(row + x, below + x);
  }
}

/// Plateaus without a lower neighbour, numbered from 0.
Regions minima(const std::vector<uint8_t>& relief, Size size, bool wraps) {
  Regions out{std::vector<uint32_t>(relief.size(), no_region), 0};
  std::vector<uint8_t> seen(relief.size());
  std::vector<uint32_t> plateau;
  for (uint32_t start = 0; start < relief.size(); start++) {
    if (seen[start]) continue;
    bool lowest = true;
    plateau.assign(1, start);
    seen[start] = 1;
    for (size_t i = 0; i < plateau.size(); i++)
      for_neighbours(plateau[i], size, wraps, [&](uint32_t to) {
        if (relief[to] < relief[start]) lowest = false;
        if (relief[to] != relief[start] || seen[to]) return;
        seen[to] = 1;
        plateau.push_back(to);
      });
    if (!lowest) continue;
    for (const uint32_t p : plateau) out.at[p] = uint32_t(out.count);
    out.count++;
  }
  return out;
}

/// A region's borders with its neighbours, by their numbers.
class Neighbours {
 public:
  struct Shared {
    uint32_t with;
    int64_t length, height;
  };

  /// Null if the regions have no common border.
  const Shared* find(uint32_t with) const {
    const auto at = place_of(with);
    return at != all_.end() && at->with == with ? &*at : nullptr;
  }
  /// Adds to the existing value; returns the sum.
  Shared add(const Shared& s) {
    const auto at = place_of(s.with);
    if (at == all_.end() || at->with != s.with) return *all_.insert(at, s);
    Shared& sum = all_[size_t(at - all_.begin())];
    sum.length += s.length;
    sum.height += s.height;
    return sum;
  }
  void reserve(size_t count) { all_.reserve(count); }
  void erase(uint32_t with) {
    if (find(with)) all_.erase(place_of(with));
  }
  std::vector<Shared> taken() { return std::exchange(all_, {}); }

 private:
  std::vector<Shared>::const_iterator place_of(uint32_t with) const {
    return std::ranges::lower_bound(all_, with, {}, &Shared::with);
  }
  std::vector<Shared> all_;
};

/// Joins regions one by one.
class Joining {
 public:
  Joining(const Regions& regions, const std::vector<RegionBorder>& borders, const JoiningRule& rule)
      : rule_(rule), joined_(size_t(regions.count)), areas_(size_t(regions.count)), neighbours_(size_t(regions.count)) {
    for (const uint32_t r : regions.at) areas_[r]++;
    reserve_neighbours(borders);
    for (const RegionBorder& b : borders) {
      neighbours_[b.a].add({b.b, b.length, b.height});
      neighbours_[b.b].add({b.a, b.length, b.height});
      offer(b.a, b.b, b.length, b.height);
    }
    while (!queue_.empty()) {
      const Candidate c = queue_.top();
      queue_.pop();
      // A border that has grown was queued again. As regions grow, fewer of them may be joined.
      const Neighbours::Shared* s = neighbours_[c.a].find(c.b);
      if (!s || s->length != c.length) continue;
      const double now = order(c.a, c.b, s->length, s->height);
      if (now > c.order)
        offer(c.a, c.b, s->length, s->height);
      else
        join(c.a, c.b);
    }
  }

  uint32_t root(uint32_t r) { return joined_.find(r); }

 private:
  static constexpr double never = 1e9;

  /// Growing lists one by one would take most of the time.
  void reserve_neighbours(const std::vector<RegionBorder>& borders) {
    std::vector<uint32_t> counts(neighbours_.size());
    for (const RegionBorder& b : borders) {
      counts[b.a]++;
      counts[b.b]++;
    }
    for (size_t r = 0; r < counts.size(); r++) neighbours_[r].reserve(counts[r]);
  }

  struct Candidate {
    double order;
    uint32_t a, b;
    int64_t length;  ///< of the border when it was queued
    bool operator<(const Candidate& o) const { return std::tie(o.order, o.a, o.b) < std::tie(order, a, b); }
  };

  double order(uint32_t a, uint32_t b, int64_t length, int64_t height) const {
    const double mean = double(height) / double(length);
    const int64_t smaller = std::min(areas_[a], areas_[b]);
    if (smaller < rule_.smallest) return mean - 256;
    return mean >= (smaller >= rule_.large ? rule_.least_of_large : rule_.least) ? never : mean;
  }

  void offer(uint32_t a, uint32_t b, int64_t length, int64_t height) {
    if (a > b) std::swap(a, b);
    if (const double o = order(a, b, length, height); o < never) queue_.push({o, a, b, length});
  }

  /// `a`, the smaller number, stays and stands for both.
  void join(uint32_t a, uint32_t b) {
    joined_.join(a, b);
    areas_[a] += areas_[b];
    neighbours_[a].erase(b);
    for (const Neighbours::Shared& s : neighbours_[b].taken()) {
      if (s.with == a) continue;
      const Neighbours::Shared both = neighbours_[a].add(s);
      neighbours_[s.with].erase(b);
      neighbours_[s.with].add({a, s.length, s.height});
      offer(a, s.with, both.length, both.height);
    }
  }

  JoiningRule rule_;
  DisjointSets joined_;
  std::vector<int64_t> areas_;
  std::vector<Neighbours> neighbours_;
  std::priority_queue<Candidate> queue_;
};

}  // namespace

Regions catchment_basins(const std::vector<uint8_t>& relief, Size size, bool wraps) {
  return flooded(relief, size, wraps, minima(relief, size, wraps).at);
}

Regions flooded(const std::vector<uint8_t>& relief, Size size, bool wraps, std::vector<uint32_t> seeds) {
  std::array<std::vector<uint32_t>, 256> rising;  // pixels to go on from, by height
  for (uint32_t p = 0; p < seeds.size(); p++)
    if (seeds[p] != no_region) rising[relief[p]].push_back(p);
  Regions out{std::move(seeds), 0};
  for (size_t height = 0; height < rising.size(); height++)
    for (size_t i = 0; i < rising[height].size(); i++) {
      const uint32_t p = rising[height][i];
      for_neighbours(p, size, wraps, [&](uint32_t to) {
        if (out.at[to] != no_region) return;
        out.at[to] = out.at[p];
        rising[std::max(height, size_t(relief[to]))].push_back(to);
      });
    }
  for (const uint32_t r : out.at)
    if (r != no_region) out.count = std::max(out.count, int(r) + 1);
  return out;
}

std::vector<RegionBorder> region_borders(const Regions& regions, const std::vector<uint8_t>& relief, Size size,
                                         bool wraps) {
  // Pairs of adjacent pixels are sorted by their lower region, then by the other one.
  struct Pair {
    uint32_t b;
    uint8_t height;
  };
  std::vector<uint32_t> ends(size_t(regions.count) + 1);
  for_pairs(regions, size, wraps, [&](uint32_t a, uint32_t, uint32_t, uint32_t) { ends[a + 1]++; });
  for (size_t r = 1; r < ends.size(); r++) ends[r] += ends[r - 1];
  std::vector<Pair> pairs(ends.back());
  std::vector<uint32_t> next(ends.begin(), ends.end() - 1);
  for_pairs(regions, size, wraps, [&](uint32_t a, uint32_t b, uint32_t p, uint32_t q) {
    pairs[next[a]++] = {b, std::max(relief[p], relief[q])};
  });
  std::vector<RegionBorder> out;
  for (uint32_t a = 0; a + 1 < ends.size(); a++) {
    const std::span all = std::span(pairs).subspan(ends[a], ends[a + 1] - ends[a]);
    std::ranges::sort(all, {}, &Pair::b);
    for (size_t i = 0; i < all.size(); i++) {
      if (i == 0 || all[i].b != all[i - 1].b) out.push_back({a, all[i].b});
      out.back().length++;
      out.back().height += all[i].height;
    }
  }
  return out;
}

Regions joined(const Regions& regions, const std::vector<RegionBorder>& borders, const JoiningRule& rule) {
  Joining joining(regions, borders, rule);
  Regions out{regions.at, 0};
  std::vector<uint32_t> names(size_t(regions.count), no_region);
  for (uint32_t& r : out.at) {
    uint32_t& name = names[joining.root(r)];
    if (name == no_region) name = uint32_t(out.count++);
    r = name;
  }
  return out;
}

}  // namespace terrazzo
