#include "core/synthesis/steps/graphcut_repair.h"

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include "core/base/hash.h"
#include "core/base/tuning.h"
#include "core/synthesis/state/expansion.h"
#include "core/synthesis/state/rounds.h"

namespace terrazzo {

namespace {

// Windows are named by their middles.
constexpr int half = 6;  // a window's pixels to each side of its middle
constexpr int core = 4;  // the same without the rim, which is compared

struct GraphcutRepairTuning {
  int near = 20;
  int random_places = 16;
  int rim_stride = 2;
  int near_stride = 2;
};
const Tunable<GraphcutRepairTuning> graphcut_repair_tuning(
    "graphcut_repair",
    {
        {&GraphcutRepairTuning::near, "near", "pixels from a window's middle",
         "higher: what is repaired repeats less; lower: more places may fit, and fewer windows stay broken",
         "graphcut_repair", half + 1, 1000},
        {&GraphcutRepairTuning::random_places, "random_places", "candidates for a window",
         "higher: a better patch is found now and then; costs time", "graphcut_repair"},
        {&GraphcutRepairTuning::rim_stride, "rim_stride", "pixels of the rim",
         "higher: fewer of the rim's pixels propose candidates, which saves time; lower: more candidates",
         "What each rule decides", 1, 1000},
        {&GraphcutRepairTuning::near_stride, "near_stride", "pixels in x and y",
         "higher: fewer pixels are searched for repeats, which saves time; lower: smaller repeats are found",
         "What each rule decides", 1, 1000},
    });

/// Covers windows with patches of the exemplar, named by the exemplar position that the window's middle would show.
/// Not thread-safe.
class Patches {
 public:
  Patches(ExpansionProblem& problem, const UsagePenalty& usage, uint64_t seed)
      : problem_(problem),
        level_(problem.level),
        usage_(usage),
        seed_(seed),
        rim_(scattered_rim()),
        expansion_(problem) {}

  /// Offers a window the patch that fits its rim best: a minimum cut takes as much of it as lowers the mismatch.
  void repair(int x, int y) {
    const std::optional<ExemplarPixel> middle = best(x, y);
    if (!middle) return;
    for (int dy = -half; dy <= half; dy++)
      for (int dx = -half; dx <= half; dx++) {
        const int u = middle->x + dx, v = middle->y + dy;
        if (level_.holds(u, v)) expansion_.offer(int(problem_.plane.index(x + dx, y + dy)), {uint16_t(u), uint16_t(v)});
      }
    expansion_.apply();
  }

 private:
  struct Offset {
    int x, y;
  };

  /// The window's pixels around its core, each far from the one before, so that sums soon exceed their limit.
  static std::vector<Offset> scattered_rim() {
    std::vector<Offset> rim, scattered;
    for (int y = -half; y <= half; y++)
      for (int x = -half; x <= half; x++)
        if (std::max(std::abs(x), std::abs(y)) > core) rim.push_back({x, y});
    constexpr size_t stride = 37;  // coprime to the number of pixels: each comes once
    static_assert(((2 * half + 1) * (2 * half + 1) - (2 * core + 1) * (2 * core + 1)) % stride != 0);
    for (size_t i = 0; i < rim.size(); i++) scattered.push_back(rim[i * stride % rim.size()]);
    return scattered;
  }

  /// None if there is no candidate. Candidates come from the rim's pixels, their k-coherent candidates and chance; none
  /// shows near by already or is out of phase.
  std::optional<ExemplarPixel> best(int x, int y) {
    shown_.clear();
    for (const Offset& o : rim_) {
      const ExemplarPixel p = pixel(x + o.x, y + o.y);
      shown_.push_back(level_.exemplar.at(p.x, p.y));
    }
    collect_places(x, y);
    std::optional<ExemplarPixel> best;
    int64_t least = std::numeric_limits<int64_t>::max();
    for (const auto& [votes, id] : places_) {
      const ExemplarPixel place = unpacked(id);
      const int64_t misfit = misfit_at(place, least);
      if (misfit > least || (misfit == least && best && id >= packed(*best)) || shows_near(x, y, place)) continue;
      least = misfit;
      best = place;
    }
    return best;
  }

  ExemplarPixel pixel(int x, int y) const { return problem_.field.pixels[size_t(problem_.plane.index(x, y))]; }

  void collect_places(int x, int y) {
    proposed_.clear();
    places_.clear();
    for (size_t i = 0; i < rim_.size(); i += size_t(graphcut_repair_tuning->rim_stride)) {
      const Offset& o = rim_[i];
      const ExemplarPixel p = pixel(x + o.x, y + o.y);
      add_place(x, y, p.x - o.x, p.y - o.y);
      for (const ExemplarPixel& q : level_.similar_to(p)) add_place(x, y, q.x - o.x, q.y - o.y);
    }
    for (int k = 0; k < graphcut_repair_tuning->random_places; k++) {
      auto [u, v] = level_.exemplar.place(random_bits(seed_, level_.level, x, y, k));
      level_.phase.snap(x, y, u, v);
      add_place(x, y, u, v);
    }
    // Each once, the most proposed first: those fit best more often than not, so that the others are rejected early.
    std::ranges::sort(proposed_);
    for (auto i = proposed_.begin(), next = i; i != proposed_.end(); i = next) {
      next = std::upper_bound(i, proposed_.end(), *i);
      places_.emplace_back(i - next, *i);
    }
    std::ranges::sort(places_);
  }

  /// Adds a candidate unless its patch would leave the exemplar or be out of phase.
  void add_place(int x, int y, int u, int v) {
    const Size size = level_.exemplar.size();
    const int least = half + level_.exemplar.keep_off();
    if (u < least || v < least || u >= size.width - least || v >= size.height - least) return;
    if (level_.phase.active() && level_.phase.penalty(u, v, x, y) > 1) return;
    proposed_.push_back(packed(u, v));
  }

  /// The distance between the patch's rim and the window's, times the place's usage penalty; stops beyond the limit.
  int64_t misfit_at(const ExemplarPixel& place, int64_t limit) const {
    const AppearanceVector* middle = level_.exemplar.at(place.x, place.y);
    const int64_t factor = usage_.factor(place.x, place.y);
    int64_t sum = 0;
    for (size_t i = 0; i < rim_.size() && sum <= limit; i++)
      sum += factor * squared_distance(*shown_[i], middle[rim_[i].y * level_.exemplar.stride() + rim_[i].x]);
    return sum;
  }

  /// Whether the core would repeat what shows near the window already, other than what continues into the window.
  bool shows_near(int x, int y, const ExemplarPixel& place) const {
    const int near = graphcut_repair_tuning->near, stride = graphcut_repair_tuning->near_stride;
    for (int dy = -near; dy <= near; dy += stride)
      for (int dx = -near; dx <= near; dx += stride) {
        if (std::max(std::abs(dx), std::abs(dy)) <= half) continue;
        const int64_t i = problem_.plane.index(x + dx, y + dy);
        if (i < 0) continue;
        const ExemplarPixel p = problem_.field.pixels[size_t(i)];
        const int u = p.x - place.x, v = p.y - place.y;
        if (u == dx && v == dy) continue;
        if (std::max(std::abs(u), std::abs(v)) <= core) return true;
      }
    return false;
  }

  ExpansionProblem& problem_;
  const CorrectionLevel& level_;
  const UsagePenalty& usage_;
  uint64_t seed_;
  std::vector<Offset> rim_;
  std::vector<const AppearanceVector*> shown_;          // what the rim shows
  std::vector<uint32_t> proposed_;                      // candidates, packed
  std::vector<std::pair<ptrdiff_t, uint32_t>> places_;  // the same, after minus the times that each is proposed
  Expansion expansion_;
};

/// The mismatch of every pixel with its right and its lower neighbour.
std::vector<int32_t> mismatches(const ExpansionProblem& problem) {
  const Plane& plane = problem.plane;
  std::vector<int32_t> out(problem.field.pixels.size(), 0);
  tbb::parallel_for(0, plane.size.height, [&](int y) {
    for (int i = y * plane.size.width; i < (y + 1) * plane.size.width; i++)
      for (int side = 0; side < 2; side++)
        if (const int64_t n = plane.beside(i, side); n >= 0)
          out[i] += int32_t(problem.mismatch(problem.field.pixels[i], problem.field.pixels[size_t(n)], side));
  });
  return out;
}

/// The sum of values over the core around every pixel; 0 where the window does not lie within the field, or around the
/// borders of one that is small.
std::vector<int32_t> core_sums(const std::vector<int32_t>& values, const Plane& plane) {
  const int width = plane.size.width, height = plane.size.height, near = graphcut_repair_tuning->near;
  const bool closed_x = plane.tile_x && width > 2 * near, closed_y = plane.tile_y && height > 2 * near;
  std::vector<int32_t> across(values.size(), 0), out(values.size(), 0);
  tbb::parallel_for(0, height, [&](int y) {
    for (int x = 0; x < width; x++)
      if (closed_x || (x >= half && x < width - half))
        for (int d = -core; d <= core; d++) across[y * width + x] += values[y * width + wrap(x + d, width)];
  });
  tbb::parallel_for(0, height, [&](int y) {
    if (!closed_y && (y < half || y >= height - half)) return;
    for (int x = 0; x < width; x++)
      for (int d = -core; d <= core; d++) out[y * width + x] += across[wrap(y + d, height) * width + x];
  });
  return out;
}

/// The middles of windows whose seams mismatch more than the average, the worst first. None lies in another's core.
std::vector<int> worst_windows(const ExpansionProblem& problem) {
  const Size size = problem.field.size;
  const std::vector<int32_t> values = mismatches(problem), sums = core_sums(values, problem.plane);
  int64_t total = 0;
  for (const int32_t v : values) total += v;
  const int64_t average = total * (2 * core + 1) * (2 * core + 1) / size.area();
  std::vector<int> order, out;
  for (size_t i = 0; i < sums.size(); i++)
    if (sums[i] > average) order.push_back(int(i));
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return sums[a] > sums[b]; });
  std::vector<uint8_t> taken(sums.size(), 0);
  for (const int i : order) {
    if (taken[i]) continue;
    out.push_back(i);
    for (int dy = -core; dy <= core; dy++)
      for (int dx = -core; dx <= core; dx++)
        taken[size_t(wrap(i / size.width + dy, size.height)) * size.width + wrap(i % size.width + dx, size.width)] = 1;
  }
  return out;
}

}  // namespace

void repair_seams(Field& field, const CorrectionLevel& level, UsagePenalty& usage, uint64_t seed, const Task& task) {
  usage.recount(field, level.fixed);
  ExpansionProblem problem(field, level);
  task.check();
  const std::vector<int> windows = worst_windows(problem);
  // In that order. A window's own pixels are written, those up to `near` from its middle are read.
  Rounds rounds(problem.plane, (graphcut_repair_tuning->near + half) / 3 + 1);
  for (const int i : windows) rounds.add(i, {&i, 1});
  tbb::enumerable_thread_specific<Patches> patches([&] { return Patches(problem, usage, seed); });
  for (const std::vector<int>& round : rounds.all())
    tbb::parallel_for(size_t{0}, round.size(), [&](size_t i) {
      task.check();
      patches.local().repair(round[i] % field.size.width, round[i] / field.size.width);
    });
}

}  // namespace terrazzo
