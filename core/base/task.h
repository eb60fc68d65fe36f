#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <utility>

#include "core/base/error.h"

namespace terrazzo {

class UvMap;

/// The progress reporting and cancellation of a long computation. Thread-safe.
class Task {
 public:
  Task() = default;
  /// `cancelled` may be null; `progress` is called with values in [0, 1], from any thread, and must be quick.
  /// `preview` is called with coarse forms of a uv map while it is made, by the thread that makes it, and must be
  /// quick. Without it none are made.
  using Preview = std::function<void(const std::shared_ptr<const UvMap>&)>;
  Task(const std::atomic<bool>* cancelled, std::function<void(double)> progress, Preview preview = {})
      : cancelled_(cancelled), progress_(std::move(progress)), preview_(std::move(preview)) {}

  bool cancelled() const { return cancelled_ && cancelled_->load(std::memory_order_relaxed); }
  /// Throws Cancelled once the run has been cancelled. Call at least every 100 ms or so.
  void check() const {
    if (cancelled()) throw Cancelled();
  }
  /// Reports the fraction done, then check().
  void progress(double fraction) const {
    if (progress_) progress_(fraction);
    check();
  }
  /// The task of a part of the work: what it reports goes to `progress`, which turns it into a fraction of the whole.
  Task part(std::function<void(double)> progress) const { return {cancelled_, std::move(progress), preview_}; }
  /// Whether anybody wants to see how a result comes about; previews never change it.
  bool is_previewed() const { return bool(preview_); }
  void preview(const std::shared_ptr<const UvMap>& coarse) const {
    if (preview_) preview_(coarse);
  }

 private:
  const std::atomic<bool>* cancelled_ = nullptr;
  std::function<void(double)> progress_;
  Preview preview_;
};

/// While it lives, makes `task` the current task of this thread. Pixels are computed on demand, deep inside code that
/// has no task parameter; such code checks the current task for cancellation. A loop that pulls pixels on other threads
/// must set the task on each of them.
class CurrentTask {
 public:
  /// `task` must outlive the object.
  explicit CurrentTask(const Task& task) : before_(current_) { current_ = &task; }
  ~CurrentTask() { current_ = before_; }
  CurrentTask(const CurrentTask&) = delete;
  CurrentTask& operator=(const CurrentTask&) = delete;

  /// The current task of this thread; if none is set, one that is never cancelled.
  static const Task& task() {
    static const Task nobody;
    return current_ ? *current_ : nobody;
  }

 private:
  static inline thread_local const Task* current_ = nullptr;
  const Task* before_;
};

}  // namespace terrazzo
