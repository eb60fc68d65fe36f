#include "core/image/computed_pixels.h"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <set>
#include <stdexcept>
#include <utility>

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include "core/base/tuning.h"
#include "core/image/image_limits.h"
#include "core/image/pixel_buffer.h"
#include "core/image/pixel_maker.h"

namespace terrazzo {

namespace {

struct ComputedPixelsTuning {
  double most_work_repeated = 1.3;
  int longest_pull = 32;
  int strip_rows = 64;
  int most_images_repeated = 16;
  int values_at_once = 1 << 20;
  int most_values_at_once = 1 << 24;
  int least_values_of_a_strip = 1 << 16;
};
const Tunable<ComputedPixelsTuning> computed_pixels_tuning(
    "computed_pixels",
    {
        {&ComputedPixelsTuning::most_work_repeated, "most_work_repeated", "factor",
         "by which a pull by strips may be more work than one of the whole image. Higher: less memory; lower: less "
         "time",
         "not measured: blurs of a radius over 6 pixels are more"},
        {&ComputedPixelsTuning::longest_pull, "longest_pull", "images",
         "higher: fewer images keep their pixels; costs stack and time",
         "not measured: bounds what a pull holds at once", 1},
        {&ComputedPixelsTuning::strip_rows, "strip_rows", "rows",
         "in which images are pulled, and which decide whether surroundings cost too much. Higher: surroundings are "
         "computed less often; lower: less memory",
         "not measured: as many as cost little memory at 8192 pixels a row", 1},
        {&ComputedPixelsTuning::most_images_repeated, "most_images_repeated", "images",
         "that may be computed again in all for the readers of one. Higher: less memory; lower: less time",
         "not measured: taken over from the code before constants were listed"},
        {&ComputedPixelsTuning::values_at_once, "values_at_once", "values",
         "that a pull computes of the image. Higher: surroundings are computed less often; lower: less memory",
         "not measured: taken over from the code before constants were listed"},
        {&ComputedPixelsTuning::most_values_at_once, "most_values_at_once", "values",
         "that a pull computes of a larger image that it is made from. Higher: less time; lower: less memory",
         "not measured: taken over from the code before constants were listed"},
        {&ComputedPixelsTuning::least_values_of_a_strip, "least_values_of_a_strip", "values",
         "that one thread computes at once. Higher: surroundings are computed less often; lower: more threads have "
         "work",
         "not measured: taken over from the code before constants were listed"},
    });

constexpr auto patience =
    std::chrono::milliseconds(50);  ///< the interval at which a waiting thread checks for cancellation

int rows_of(Size size, int channels, int64_t values) {
  return int(std::max<int64_t>(computed_pixels_tuning->strip_rows, values / (int64_t{size.width} * channels)));
}

/// Limits the memory of all threads' pulls, with a few images each, to a part of the budget.
int64_t most_values_at_once() {
  constexpr uint64_t share = 64;
  return std::min<int64_t>(computed_pixels_tuning->most_values_at_once, int64_t(memory_budget() / share));
}

}  // namespace

int longest_pull() {
  return computed_pixels_tuning->longest_pull;
}

/// Pixels being computed. Threads take strips until none are left.
struct ComputedPixels::Filling {
  Filling(Size size, int channels)
      : pixels(size, channels),
        rows(rows_of(size, channels, computed_pixels_tuning->least_values_of_a_strip)),
        strips((size.height + rows - 1) / rows) {}

  /// A strip for the calling thread; -1 if all have been taken.
  int take() {
    const std::lock_guard lock(mutex);
    if (failure) std::rethrow_exception(failure);
    if (!returned.empty()) {
      const int strip = returned.back();
      returned.pop_back();
      return strip;
    }
    return next < strips ? next++ : -1;
  }

  PixelBuffer pixels;
  const int rows;  ///< of a strip
  const int strips;
  std::mutex mutex;
  std::condition_variable changed;
  int next = 0;               ///< the first strip not taken yet
  int done = 0;               ///< number of computed strips
  std::vector<int> returned;  ///< strips of cancelled threads, to be taken again
  std::exception_ptr failure;
};

ComputedPixels::ComputedPixels(Size size, int channels, Operation operation)
    : size_(size), channels_(channels), operation_(std::make_shared<Operation>(std::move(operation))) {}

std::shared_ptr<const ComputedPixels> ComputedPixels::make(Size size, int channels, Operation operation) {
  std::shared_ptr<ComputedPixels> made(new ComputedPixels(size, channels, std::move(operation)));
  made->choose_kept();
  if (made->operation_->keeps) made->to_be_kept_ = true;
  return made;
}

std::shared_ptr<const ComputedPixels> ComputedPixels::of(const Image& image) {
  return std::dynamic_pointer_cast<const ComputedPixels>(image.source());
}

/// Decides whether to keep the sources' pixels, now that there is one more reader.
void ComputedPixels::choose_kept() {
  std::set<std::shared_ptr<const ComputedPixels>> sources;
  for (const ImagePtr& image : operation_->sources)
    if (auto source = of(*image)) sources.insert(std::move(source));
  const auto length = [&] { return PullPlan(*this, PullPlan::Until::to_be_kept).length(); };
  if (length() > size_t(computed_pixels_tuning->longest_pull))
    for (const auto& source : sources)
      if (source->pull_length_ > 1) source->to_be_kept_ = true;
  if (PullPlan(*this, PullPlan::Until::to_be_kept).work_by_strips(computed_pixels_tuning->strip_rows) >
      computed_pixels_tuning->most_work_repeated)
    for (const auto& source : sources) source->to_be_kept_ = true;
  for (const auto& source : sources) {
    const int readers = ++source->readers_;
    if (readers > 1 && int64_t{readers} * source->pull_length_ > computed_pixels_tuning->most_images_repeated)
      source->to_be_kept_ = true;
  }
  pull_length_ = int(length());
}

std::shared_ptr<const Operation> ComputedPixels::operation() const {
  if (is_kept_) return nullptr;
  const std::lock_guard lock(mutex_);
  return operation_;
}

void ComputedPixels::read(const Rect& region, float* out) const {
  if (!is_kept_) {
    PullPlan plan(*this, PullPlan::Until::kept);
    if (plan.passes_by_kept()) {
      plan.keep_pixels();
      plan = PullPlan(*this, PullPlan::Until::kept);
    }
    if (plan.length() > 0) {
      const int rows = rows_at_once(plan, region);
      for (int y = 0; y < region.height; y += rows)
        plan.pull({region.x, region.y + y, region.width, std::min(rows, region.height - y)},
                  out + int64_t{y} * region.width * channels_);
      return;
    }
  }
  filling_->pixels.read(region, out);
}

int ComputedPixels::rows_at_once(PullPlan& plan, const Rect& region) const {
  if (plan.length() == 1) return region.height;
  int rows = std::min(region.height, rows_of({region.width, 1}, channels_, computed_pixels_tuning->values_at_once));
  while (rows > 1 && plan.most_values({region.x, region.y, region.width, rows}) > most_values_at_once())
    rows = (rows + 1) / 2;
  return rows;
}

std::shared_ptr<ComputedPixels::Filling> ComputedPixels::filling() const {
  const std::lock_guard lock(mutex_);
  if (!filling_) filling_ = std::make_shared<Filling>(size_, channels_);
  return filling_;
}

void ComputedPixels::compute_strip(Filling& filling, int strip) const {
  const int y = strip * filling.rows;
  const Rect region{0, y, size_.width, std::min(filling.rows, size_.height - y)};
  PullPlan plan(*this, PullPlan::Until::kept);
  if (plan.length() == 0) return;  // another thread has computed everything meanwhile
  if (float* rows = filling.pixels.rows_in_memory(y)) return plan.pull(region, rows);
  const std::unique_ptr<float[]> pixels(new float[size_t(region.area()) * channels_]);
  plan.pull(region, pixels.get());
  filling.pixels.write_rows(y, region.height, pixels.get());
}

/// Computes strips until all have been taken.
void ComputedPixels::help(Filling& filling) const {
  for (int strip; (strip = filling.take()) >= 0;) {
    try {
      compute_strip(filling, strip);
    } catch (const Cancelled&) {
      // Other threads can take the strip.
      const std::lock_guard lock(filling.mutex);
      filling.returned.push_back(strip);
      filling.changed.notify_all();
      throw;
    } catch (...) {
      const std::lock_guard lock(filling.mutex);
      filling.failure = std::current_exception();
      filling.changed.notify_all();
      throw;
    }
    const std::lock_guard lock(filling.mutex);
    if (++filling.done == filling.strips) filling.changed.notify_all();
  }
}

/// Waits until the strips taken by other threads are computed.
void ComputedPixels::await(Filling& filling) const {
  std::unique_lock lock(filling.mutex);
  while (filling.done < filling.strips) {
    if (filling.failure) std::rethrow_exception(filling.failure);
    if (!filling.returned.empty()) {
      lock.unlock();
      help(filling);
      lock.lock();
      continue;
    }
    filling.changed.wait_for(lock, patience);
    CurrentTask::task().check();
  }
}

void ComputedPixels::finish() const {
  std::shared_ptr<const Operation> unneeded;
  const std::lock_guard lock(mutex_);
  is_kept_ = true;
  unneeded.swap(operation_);
}

/// The next reader starts over.
void ComputedPixels::give_up(const std::shared_ptr<Filling>& filling) const {
  const std::lock_guard lock(mutex_);
  if (filling_ == filling && filling->failure) filling_.reset();
}

void ComputedPixels::keep() const {
  if (is_kept_) return;
  const std::shared_ptr<Filling> all = filling();
  const Task& task = CurrentTask::task();
  task.check();
  try {
    if (all->strips == 1)
      help(*all);
    else
      // Isolated: a thread that waits for others must not pick up work that waits for it.
      tbb::this_task_arena::isolate([&] {
        tbb::parallel_for(0, std::min(all->strips, tbb::this_task_arena::max_concurrency()), [&](int) {
          const CurrentTask scope(task);
          help(*all);
        });
      });
    await(*all);
  } catch (...) {
    give_up(all);
    throw;
  }
  finish();
}

ImagePtr Image::computed(ImageInfo info, const Digest& recipe, Operation operation) {
  info.check();
  if (std::ranges::find(operation.sources, nullptr) != operation.sources.end())
    throw std::logic_error("an image cannot be computed from one that is null");
  Hasher h;
  h.add("computed image");
  info.add_to(h);
  h.add(recipe);
  auto source = ComputedPixels::make(info.size, info.channels, blaming_maker(std::move(operation)));
  return with_digest(std::move(info), h.digest(), std::move(source));
}

ImagePtr Image::computed(ImageInfo info, const Digest& recipe, std::shared_ptr<const PixelSource> source) {
  if (!source) throw std::logic_error("an image needs a source of pixels, found null");
  return computed(std::move(info), recipe,
                  [source = std::move(source)](const Rect& region, float* out) { source->read(region, out); });
}

ImagePtr Image::computed(ImageInfo info, const Digest& recipe, std::function<void(const Rect&, float*)> read) {
  Operation made_from_nothing{
      .sources = {}, .compute = [read = std::move(read)](auto, const Rect& region, float* out) { read(region, out); }};
  return computed(std::move(info), recipe, std::move(made_from_nothing));
}

}  // namespace terrazzo
