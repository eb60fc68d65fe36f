#include "core/synthesis/steps/coherence_repair.h"

#include <array>
#include <vector>

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include "core/synthesis/state/patches.h"
#include "core/synthesis/state/usage_penalty.h"
#include "core/synthesis/state/window_coherence.h"

namespace terrazzo {

namespace {

constexpr int32_t unlike = WindowCoherence::most / 2;      // windows that are so unlike any begin the work
constexpr int64_t worthwhile = WindowCoherence::most / 2;  // what incoherence must fall by

/// What a field shows around a window, far enough to tell how like the exemplar all is that the window has a part in.
class Surroundings {
 public:
  static constexpr int touched =
      Patches::half + WindowCoherence::reach;  // windows of pixels that may change lie so near

  Surroundings(const Field& field, const PlaneWindow& part, const WindowCoherence& window_coherence)
      : field_(field), part_(part), window_coherence_(window_coherence) {}

  /// Goes to a pixel's surroundings, and gives the incoherence of all windows that the window around it has a part in.
  int64_t read(int x, int y) {
    go_to(x, y);
    for_each(pixels_held, [&](int dx, int dy) { read_pixel(dx, dy); });
    begun_ = shown_;
    int64_t sum = 0;
    for_each(touched, [&](int dx, int dy) { sum += begun_unlikeness_[at(dx, dy)] = incoherence(dx, dy); });
    return sum;
  }

  /// The same once the window's pixels may show something else than at first; gives up beyond the limit, and at once
  /// if they do not.
  int64_t read_again(int64_t limit) {
    changed_.fill(0);
    bool any = false;
    for_each(Patches::half, [&](int dx, int dy) {
      read_pixel(dx, dy);
      const bool changed = shown_[at(dx, dy)] != begun_[at(dx, dy)];
      any |= changed;
      if (changed) mark(dx, dy);
    });
    if (!any) return limit;
    int64_t sum = 0;
    for_each(touched, [&](int dx, int dy) { sum += changed_[at(dx, dy)] ? 0 : begun_unlikeness_[at(dx, dy)]; });
    for_each(touched, [&](int dx, int dy) {
      if (changed_[at(dx, dy)] && sum < limit) sum += incoherence(dx, dy);
    });
    return sum;
  }

  /// That of the window around one pixel alone.
  int32_t unlikeness_at(int x, int y) {
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
  void read_pixel(int dx, int dy) {
    const int64_t i = index(dx, dy);
    if (i >= 0) shown_[at(dx, dy)] = field_.pixels[size_t(i)];
  }
  /// The windows that a pixel is in have changed.
  void mark(int dx, int dy) {
    for_each(WindowCoherence::reach, [&](int wx, int wy) { changed_[at(dx + wx, dy + wy)] = 1; });
  }
  static bool holds(int middle, int length, bool closed) {
    return closed || (middle >= WindowCoherence::reach && middle < length - WindowCoherence::reach);
  }
  /// Of a window that the field does not hold all of: none.
  int32_t incoherence(int dx, int dy) const {
    if (!holds(x_ + dx, field_.size.width, part_.closed_x) || !holds(y_ + dy, field_.size.height, part_.closed_y))
      return 0;
    WindowCoherence::Window window;
    size_t i = 0;
    for_each(WindowCoherence::reach, [&](int wx, int wy) { window[i++] = shown_[at(dx + wx, dy + wy)]; });
    return window_coherence_.incoherence(window);
  }

  const Field& field_;
  const PlaneWindow& part_;
  const WindowCoherence& window_coherence_;
  int x_ = 0, y_ = 0;
  PerPixel<ExemplarPixel> shown_{}, begun_{};
  PerPixel<int32_t> begun_unlikeness_{};
  PerPixel<uint8_t> changed_{};
};

/// One per thread.
class Reworker {
 public:
  Reworker(ExpansionGround& ground, const UsagePenalty& usage, const WindowCoherence& window_coherence, int tries,
           uint64_t seed)
      : field_(ground.field),
        tries_(tries),
        patches_(ground, usage, seed),
        surroundings_(ground.field, ground.level.window, window_coherence) {}

  void rework(int x, int y) {
    int64_t least = surroundings_.read(x, y) - worthwhile;
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
  }

  int32_t incoherence(int x, int y) { return surroundings_.unlikeness_at(x, y); }

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
  tbb::enumerable_thread_specific<Reworker> reworkers(
      [&] { return Reworker(ground, usage, window_coherence, tries, seed); });
  const Size size = field.size;
  std::vector<int32_t> values(field.pixels.size());
  const int step = level.level <= Patches::many_pixels ? 2 : 1;  // every second window, in x and in y
  tbb::parallel_for(0, (size.height + step - 1) / step, [&](int row) {
    task.check();
    for (int x = 0; x < size.width; x += step)
      values[size_t(row) * step * size.width + x] = reworkers.local().incoherence(x, row * step);
  });
  std::vector<int32_t> sums = core_sums(values, size, level.window);
  for (size_t i = 0; i < sums.size(); i++)
    if (values[i] < unlike) sums[i] = 0;
  for_each_window(worst_first(sums, 0, size), field, level.window, task,
                  [&](int x, int y) { reworkers.local().rework(x, y); });
}

}  // namespace terrazzo
