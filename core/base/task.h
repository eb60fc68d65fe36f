#pragma once

#include <atomic>
#include <functional>

#include "core/base/error.h"

namespace terrazzo {

/// What a long computation owes its caller: to say how far it is, and to stop when told. Thread-safe.
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

/// Makes a task the one that this thread works for, for as long as the object lives. Pixels are computed wherever they
/// are asked for, deep inside code that was given no task: what computes them asks here whether to go on. A loop that
/// pulls pixels on other threads says so on each of them.
class CurrentTask {
 public:
  /// `task` must outlive the object.
  explicit CurrentTask(const Task& task) : before_(current_) { current_ = &task; }
  ~CurrentTask() { current_ = before_; }
  CurrentTask(const CurrentTask&) = delete;
  CurrentTask& operator=(const CurrentTask&) = delete;

  /// The task this thread works for; one that is never cancelled if nobody has said.
  static const Task& task() {
    static const Task nobody;
    return current_ ? *current_ : nobody;
  }

 private:
  static inline thread_local const Task* current_ = nullptr;
  const Task* before_;
};

}  // namespace terrazzo
