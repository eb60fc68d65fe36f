#include "core/numeric/watershed.h"

#include <algorithm>
#include <array>
#include <map>
#include <queue>
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

/// Joins regions one by one.
class Joining {
 public:
  Joining(const Regions& regions, const std::vector<RegionBorder>& borders, const JoiningRule& rule)
      : rule_(rule), joined_(size_t(regions.count)), areas_(size_t(regions.count)), shared_(size_t(regions.count)) {
    for (const uint32_t r : regions.at) areas_[r]++;
    for (const RegionBorder& b : borders) {
      shared_[b.a][b.b] = shared_[b.b][b.a] = {b.length, b.height};
      offer(b.a, b.b);
    }
    while (!queue_.empty()) {
      const Candidate c = queue_.top();
      queue_.pop();
      const auto at = shared_[c.a].find(c.b);
      // What has been joined meanwhile is in the queue anew.
      if (at != shared_[c.a].end() && at->second.length == c.length && c.areas == areas_[c.a] + areas_[c.b])
        join(c.a, c.b);
    }
  }

  uint32_t root(uint32_t r) { return joined_.find(r); }

 private:
  struct Shared {
    int64_t length, height;
  };
  struct Candidate {
    double order;
    uint32_t a, b;
    int64_t length, areas;  ///< when it was put in
    bool operator<(const Candidate& o) const { return std::tie(o.order, o.a, o.b) < std::tie(order, a, b); }
  };

  void offer(uint32_t a, uint32_t b) {
    if (a > b) std::swap(a, b);
    const Shared& s = shared_[a][b];
    const double mean = double(s.height) / double(s.length);
    const int64_t smaller = std::min(areas_[a], areas_[b]);
    const bool tiny = smaller < rule_.smallest;
    if (!tiny && mean >= (smaller >= rule_.large ? rule_.least_of_large : rule_.least)) return;
    queue_.push({tiny ? mean - 256 : mean, a, b, s.length, areas_[a] + areas_[b]});
  }

  /// `a` is the smaller number, which goes on to stand for both.
  void join(uint32_t a, uint32_t b) {
    joined_.join(a, b);
    areas_[a] += areas_[b];
    shared_[a].erase(b);
    for (const auto& [other, s] : shared_[b]) {
      if (other == a) continue;
      Shared& both = shared_[a][other];
      both.length += s.length;
      both.height += s.height;
      shared_[other].erase(b);
      shared_[other][a] = both;
    }
    shared_[b].clear();
    for (const auto& [other, s] : shared_[a]) offer(a, other);
  }

  JoiningRule rule_;
  DisjointSets joined_;
  std::vector<int64_t> areas_;
  std::vector<std::map<uint32_t, Shared>> shared_;
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
  std::map<std::pair<uint32_t, uint32_t>, RegionBorder> found;
  const auto add = [&](uint32_t p, uint32_t q) {
    const auto [a, b] = std::minmax(regions.at[p], regions.at[q]);
    if (a == b) return;
    RegionBorder& border = found[{a, b}];
    border.a = a;
    border.b = b;
    border.length++;
    border.height += std::max(relief[p], relief[q]);
  };
  for (int y = 0; y < size.height; y++)
    for (int x = 0; x < size.width; x++) {
      const auto p = uint32_t(y * size.width + x);
      if (x + 1 < size.width || wraps) add(p, uint32_t(y * size.width + (x + 1) % size.width));
      if (y + 1 < size.height || wraps) add(p, uint32_t((y + 1) % size.height * size.width + x));
    }
  std::vector<RegionBorder> out;
  for (const auto& [pair, border] : found) out.push_back(border);
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
