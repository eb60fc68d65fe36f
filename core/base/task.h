#pragma once

#include <atomic>
#include <functional>

#include "core/base/error.h"

namespace terrazzo {

/// The progress reporting and cancellation of a long computation. Thread-safe.
class Task {
 public:
  Task() = default;
  /// `cancelled` may be null; `progress` is called with values in [0, 1], from any thread, and must be quick.
  Task(const std::atomic<bool>* cancelled, std::function<void(double)> progress)
      : cancelled_(cancelled), progress_(std::move(progress)) {}

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

 private:
  const std::atomic<bool>* cancelled_ = nullptr;
  std::function<void(double)> progress_;
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
