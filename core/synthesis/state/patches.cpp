#include "core/synthesis/state/patches.h"

#include <algorithm>
#include <limits>

#include <tbb/parallel_for.h>

#include "core/base/hash.h"
#include "core/base/tuning.h"
#include "core/synthesis/state/rounds.h"
#include "core/synthesis/state/usage_penalty.h"

namespace terrazzo {

namespace {

struct PatchesTuning {
  int near = 20;
  int random_places = 16;
  int rim_stride = 2;
  int near_stride = 2;
};
const Tunable<PatchesTuning> patches_tuning(
    "patches", {
                   {&PatchesTuning::near, "near", "pixels from a window's middle",
                    "higher: what is repaired repeats less; lower: more places may fit, and fewer windows stay broken",
                    "graphcut_repair", Patches::half + 1, 1000},
                   {&PatchesTuning::random_places, "random_places", "candidates for a window",
                    "higher: a better patch is found now and then; costs time", "graphcut_repair"},
                   {&PatchesTuning::rim_stride, "rim_stride", "pixels of the rim",
                    "higher: fewer of the rim's pixels propose candidates, which saves time; lower: more candidates",
                    "not measured: neighbours in one piece propose the same candidates", 1, 1000},
                   {&PatchesTuning::near_stride, "near_stride", "pixels in x and y",
                    "higher: fewer pixels are searched for repeats, which saves time; lower: smaller repeats are found",
                    "not measured: only repeats less than two pixels wide are missed", 1, 1000},
               });

// Places pack the exemplar position that a window's middle would show.
uint32_t packed(int u, int v) {
  return uint32_t(v) << 16 | uint32_t(u);
}
int column(uint32_t place) {
  return int(place & 0xffff);
}
int row(uint32_t place) {
  return int(place >> 16);
}

}  // namespace

Patches::Patches(ExpansionProblem& problem, const UsagePenalty& usage, uint64_t seed)
    : problem_(problem), usage_(usage), seed_(seed), rim_(scattered_rim()), expansion_(problem) {}

int Patches::near() {
  return patches_tuning->near;
}

/// The window's pixels around its core, each far from the one before, so that sums soon exceed their limit.
std::vector<Patches::Offset> Patches::scattered_rim() {
  std::vector<Offset> rim;
  for (int y = -half; y <= half; y++)
    for (int x = -half; x <= half; x++)
      if (std::max(std::abs(x), std::abs(y)) > core) rim.push_back({x, y});
  constexpr size_t stride = 37;  // coprime to the number of pixels: each comes once
  static_assert(((2 * half + 1) * (2 * half + 1) - (2 * core + 1) * (2 * core + 1)) % stride != 0);
  std::vector<Offset> scattered;
  for (size_t i = 0; i < rim.size(); i++) scattered.push_back(rim[i * stride % rim.size()]);
  return scattered;
}

std::optional<uint32_t> Patches::best(int x, int y) {
  shown_.clear();
  for (const Offset& o : rim_) {
    const ExemplarPixel p = pixel(x + o.x, y + o.y);
    shown_.push_back(problem_.level.exemplar.at(p.x, p.y));
  }
  collect_places(x, y);
  std::optional<uint32_t> best;
  int64_t least = std::numeric_limits<int64_t>::max();
  for (const auto& [place, votes] : places_.by_votes()) {
    const int64_t misfit = misfit_at(place, least);
    if (misfit > least || (misfit == least && best && place >= *best) || shows_near(x, y, place)) continue;
    least = misfit;
    best = place;
  }
  return best;
}

void Patches::lay(int x, int y, uint32_t place) {
  for (int dy = -half; dy <= half; dy++)
    for (int dx = -half; dx <= half; dx++) {
      const int u = column(place) + dx, v = row(place) + dy;
      if (problem_.level.exemplar.is_usable(u, v))
        expansion_.offer(int(index(x + dx, y + dy)), {uint16_t(u), uint16_t(v)});
    }
  expansion_.apply();
}

int64_t Patches::index(int x, int y) const {
  return pixel_index(problem_.field.size, x, y, problem_.level.window.closed_x, problem_.level.window.closed_y);
}

void Patches::collect_places(int x, int y) {
  const CorrectionLevel& level = problem_.level;
  places_.clear();
  for (size_t i = 0; i < rim_.size(); i += size_t(patches_tuning->rim_stride)) {
    const Offset& o = rim_[i];
    const ExemplarPixel p = pixel(x + o.x, y + o.y);
    add_place(x, y, p.x - o.x, p.y - o.y);
    const size_t first = (size_t(p.y) * level.exemplar.size().width + p.x) * size_t(level.per_pixel);
    for (int k = 0; k < level.per_pixel; k++) {
      const ExemplarPixel q = level.similar[first + size_t(k)];
      add_place(x, y, q.x - o.x, q.y - o.y);
    }
  }
  for (int k = 0; k < patches_tuning->random_places; k++) {
    auto [u, v] = level.exemplar.place(random_bits(seed_, level.level, x, y, k));
    level.phase.snap(x, y, u, v);
    add_place(x, y, u, v);
  }
}

/// Adds a candidate unless its patch would leave the exemplar or be out of phase.
void Patches::add_place(int x, int y, int u, int v) {
  const PaddedLevel& e = problem_.level.exemplar;
  const int least = half + e.keep_off();
  if (u < least || v < least || u >= e.size().width - least || v >= e.size().height - least) return;
  if (problem_.level.phase.active() && problem_.level.phase.penalty(u, v, x, y) > 1) return;
  places_.add(packed(u, v));
}

/// The distance between the patch's rim and the window's, times the place's usage penalty; stops beyond the limit.
int64_t Patches::misfit_at(uint32_t place, int64_t limit) const {
  const PaddedLevel& e = problem_.level.exemplar;
  const AppearanceVector* middle = e.at(column(place), row(place));
  const int64_t factor = usage_.factor(column(place), row(place));
  int64_t sum = 0;
  for (size_t i = 0; i < rim_.size() && sum <= limit; i++)
    sum += factor * squared_distance(*shown_[i], middle[rim_[i].y * e.stride() + rim_[i].x]);
  return sum;
}

/// Whether the core would repeat what shows near the window already, other than what continues into the window.
bool Patches::shows_near(int x, int y, uint32_t place) const {
  const int near = this->near(), stride = patches_tuning->near_stride;
  for (int dy = -near; dy <= near; dy += stride)
    for (int dx = -near; dx <= near; dx += stride) {
      if (std::max(std::abs(dx), std::abs(dy)) <= half) continue;
      const int64_t i = index(x + dx, y + dy);
      if (i < 0) continue;
      const ExemplarPixel p = problem_.field.pixels[size_t(i)];
      const int u = p.x - column(place), v = p.y - row(place);
      if (u == dx && v == dy) continue;
      if (std::max(std::abs(u), std::abs(v)) <= core) return true;
    }
  return false;
}

std::vector<int32_t> core_sums(const std::vector<int32_t>& values, Size size, const PlaneWindow& window) {
  constexpr int half = Patches::half, core = Patches::core;
  const int near = Patches::near();
  const bool closed_x = window.closed_x && size.width > 2 * near, closed_y = window.closed_y && size.height > 2 * near;
  std::vector<int32_t> across(values.size(), 0), out(values.size(), 0);
  tbb::parallel_for(0, size.height, [&](int y) {
    for (int x = 0; x < size.width; x++)
      if (closed_x || (x >= half && x < size.width - half))
        for (int d = -core; d <= core; d++)
          across[y * size.width + x] += values[y * size.width + wrap(x + d, size.width)];
  });
  tbb::parallel_for(0, size.height, [&](int y) {
    if (!closed_y && (y < half || y >= size.height - half)) return;
    for (int x = 0; x < size.width; x++)
      for (int d = -core; d <= core; d++) out[y * size.width + x] += across[wrap(y + d, size.height) * size.width + x];
  });
  return out;
}

std::vector<int> worst_first(const std::vector<int32_t>& sums, int64_t least, Size size) {
  constexpr int core = Patches::core;
  std::vector<int> order;
  for (size_t i = 0; i < sums.size(); i++)
    if (sums[i] > least) order.push_back(int(i));
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return sums[a] > sums[b]; });
  std::vector<uint8_t> taken(sums.size(), 0);
  std::vector<int> out;
  for (const int i : order) {
    if (taken[i]) continue;
    out.push_back(i);
    for (int dy = -core; dy <= core; dy++)
      for (int dx = -core; dx <= core; dx++)
        taken[size_t(wrap(i / size.width + dy, size.height)) * size.width + wrap(i % size.width + dx, size.width)] = 1;
  }
  return out;
}

void for_each_window(std::span<const int> windows, const Field& field, const PlaneWindow& part, const Task& task,
                     const std::function<void(int x, int y)>& work) {
  // A window's own pixels are written, those up to `near` from its middle are read.
  Rounds rounds(field, part, (Patches::near() + Patches::half) / 3 + 1);
  for (const int i : windows) rounds.add(i, {&i, 1});
  for (const std::vector<int>& round : rounds.all())
    tbb::parallel_for(size_t{0}, round.size(), [&](size_t i) {
      task.check();
      work(round[i] % field.size.width, round[i] / field.size.width);
    });
}

}  // namespace terrazzo
