#include "core/synthesis/steps/coherence_repair.h"

#include <algorithm>
#include <array>
#include <vector>

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include "core/base/tuning.h"
#include "core/synthesis/state/patches.h"
#include "core/synthesis/state/usage_penalty.h"
#include "core/synthesis/state/window_coherence.h"

namespace terrazzo {

namespace {

struct CoherenceRepairTuning {
  double incoherent = 0.5;
  double worthwhile = 0.5;
};
const Tunable<CoherenceRepairTuning> coherence_repair_tuning(
    "coherence_repair",
    {
        {&CoherenceRepairTuning::incoherent, "incoherent", "incoherence, 0..1",
         "higher: only windows unlike anything are repaired; lower: more are, which costs time and rare features",
         "coherence_repair", 0, 1},
        {&CoherenceRepairTuning::worthwhile, "worthwhile", "incoherent windows",
         "how much a repair must lower the sum around it. Higher: rare features survive; lower: less is left broken",
         "not measured: half a window, the least that counts as incoherent", 0, 1000},
    });

/// Incoherence in WindowCoherence's fixed-point unit.
int64_t fixed_point(double incoherence) {
  return int64_t(incoherence * WindowCoherence::most);
}

/// What a field shows around a window, and the incoherence of all windows that share pixels with it.
class Surroundings {
 public:
  /// The middles of windows that share pixels with the window lie so near.
  static constexpr int touched = Patches::half + WindowCoherence::reach;

  /// `incoherence`: of the window around each pixel of the field, kept up to date by update().
  Surroundings(const Field& field, const PlaneWindow& part, const WindowCoherence& window_coherence,
               std::vector<int32_t>& incoherence)
      : field_(field), part_(part), window_coherence_(window_coherence), known_(incoherence) {}

  /// Reads the surroundings of a pixel. Returns the summed incoherence of all windows that share pixels with its
  /// window.
  int64_t read(int x, int y) {
    go_to(x, y);
    for_each(pixels_held, [&](int dx, int dy) { read_pixel(dx, dy); });
    before_ = shown_;
    int64_t sum = 0;
    for_each(touched, [&](int dx, int dy) { sum += known(dx, dy); });
    return sum;
  }

  /// The same after the window's pixels may have changed; stops beyond the limit. Returns the limit if none has.
  int64_t read_again(int64_t limit) {
    if (!find_changed()) return limit;
    int64_t sum = 0;
    for_each(touched, [&](int dx, int dy) { sum += changed_[at(dx, dy)] ? 0 : known(dx, dy); });
    for_each(touched, [&](int dx, int dy) {
      if (changed_[at(dx, dy)] && sum < limit) sum += incoherence(dx, dy);
    });
    return sum;
  }

  /// Once the window's pixels are what they will be.
  void update() {
    if (!find_changed()) return;
    for_each(touched, [&](int dx, int dy) {
      const int64_t i = index(dx, dy);
      if (i >= 0 && changed_[at(dx, dy)]) known_[size_t(i)] = incoherence(dx, dy);
    });
  }

  /// The incoherence of the window around one pixel alone.
  int32_t incoherence_at(int x, int y) {
    go_to(x, y);
    for_each(WindowCoherence::reach, [&](int dx, int dy) { read_pixel(dx, dy); });
    return incoherence(0, 0);
  }

  int64_t index(int dx, int dy) const {
    return pixel_index(field_.size, x_ + dx, y_ + dy, part_.closed_x, part_.closed_y);
  }

 private:
  static constexpr int pixels_held = touched + WindowCoherence::reach;
  static constexpr int side = 2 * pixels_held + 1;
  template <typename T>
  using PerPixel = std::array<T, size_t(side) * side>;

  template <typename Visit>
  static void for_each(int around, const Visit& visit) {
    for (int dy = -around; dy <= around; dy++)
      for (int dx = -around; dx <= around; dx++) visit(dx, dy);
  }
  static size_t at(int dx, int dy) { return size_t((dy + pixels_held) * side + dx + pixels_held); }

  void go_to(int x, int y) {
    x_ = x;
    y_ = y;
  }
  int32_t known(int dx, int dy) const {
    const int64_t i = index(dx, dy);
    return i < 0 ? 0 : known_[size_t(i)];
  }
  /// Marks the windows that have changed since they were read; false if none has.
  bool find_changed() {
    changed_.fill(0);
    bool any = false;
    for_each(Patches::half, [&](int dx, int dy) {
      read_pixel(dx, dy);
      if (shown_[at(dx, dy)] == before_[at(dx, dy)]) return;
      mark(dx, dy);
      any = true;
    });
    return any;
  }
  void read_pixel(int dx, int dy) {
    const int64_t i = index(dx, dy);
    if (i >= 0) shown_[at(dx, dy)] = field_.pixels[size_t(i)];
  }
  /// Marks the windows that a pixel is in as changed.
  void mark(int dx, int dy) {
    for_each(WindowCoherence::reach, [&](int wx, int wy) { changed_[at(dx + wx, dy + wy)] = 1; });
  }
  /// 0 for windows that the field does not hold as a whole.
  int32_t incoherence(int dx, int dy) const {
    if (!WindowCoherence::fits(x_ + dx, field_.size.width, part_.closed_x) ||
        !WindowCoherence::fits(y_ + dy, field_.size.height, part_.closed_y))
      return 0;
    WindowCoherence::Window window;
    size_t i = 0;
    for_each(WindowCoherence::reach, [&](int wx, int wy) { window[i++] = shown_[at(dx + wx, dy + wy)]; });
    return window_coherence_.incoherence(window);
  }

  const Field& field_;
  const PlaneWindow& part_;
  const WindowCoherence& window_coherence_;
  std::vector<int32_t>& known_;
  int x_ = 0, y_ = 0;
  PerPixel<ExemplarPixel> shown_{}, before_{};
  PerPixel<uint8_t> changed_{};
};

/// Repairs one window at a time. One per thread.
class Repairer {
 public:
  Repairer(ExpansionGround& ground, const UsagePenalty& usage, const WindowCoherence& window_coherence,
           std::vector<int32_t>& incoherence, int tries, uint64_t seed)
      : field_(ground.field),
        tries_(tries),
        patches_(ground, usage, seed),
        surroundings_(ground.field, ground.level.window, window_coherence, incoherence) {}

  void repair(int x, int y) {
    int64_t least = surroundings_.read(x, y) - fixed_point(coherence_repair_tuning->worthwhile);
    if (least <= 0) return;
    save(before_);
    best_ = before_;
    for (const uint32_t place : patches_.fitting(x, y, size_t(tries_))) {
      patches_.lay(x, y, place);
      const int64_t incoherence = surroundings_.read_again(least);
      if (incoherence < least) {
        least = incoherence;
        save(best_);
      }
      restore(before_);
    }
    restore(best_);
    surroundings_.update();
  }

  int32_t incoherence(int x, int y) { return surroundings_.incoherence_at(x, y); }

 private:
  using Pixels = std::vector<ExemplarPixel>;

  template <typename Visit>
  void for_each_pixel(const Visit& visit) const {
    for (int dy = -Patches::half; dy <= Patches::half; dy++)
      for (int dx = -Patches::half; dx <= Patches::half; dx++) visit(size_t(surroundings_.index(dx, dy)));
  }
  void save(Pixels& pixels) const {
    pixels.clear();
    for_each_pixel([&](size_t i) { pixels.push_back(field_.pixels[i]); });
  }
  void restore(const Pixels& pixels) {
    size_t n = 0;
    for_each_pixel([&](size_t i) { field_.pixels[i] = pixels[n++]; });
  }

  Field& field_;
  int tries_;
  Patches patches_;
  Surroundings surroundings_;
  Pixels before_, best_;
};

}  // namespace

void repair_incoherent(Field& field, const CorrectionLevel& level, UsagePenalty& usage, int tries, uint64_t seed,
                       const Task& task) {
  usage.recount(field, level.fixed);
  const WindowCoherence window_coherence(level);
  task.check();
  ExpansionGround ground(field, level);
  std::vector<int32_t> values(field.pixels.size());
  tbb::enumerable_thread_specific<Repairer> repairers(
      [&] { return Repairer(ground, usage, window_coherence, values, tries, seed); });
  const Size size = field.size;
  const int64_t incoherent = fixed_point(coherence_repair_tuning->incoherent);
  tbb::parallel_for(0, size.height, [&](int y) {
    task.check();
    for (int x = 0; x < size.width; x++) values[size_t(y) * size.width + x] = repairers.local().incoherence(x, y);
  });
  std::vector<int32_t> sums = core_sums(values, size, level.window);
  for (size_t i = 0; i < sums.size(); i++)
    if (values[i] < incoherent) sums[i] = 0;
  for_each_window(worst_first(sums, 0, size), field, level.window, task,
                  [&](int x, int y) { repairers.local().repair(x, y); });
}

}  // namespace terrazzo
