#include "runner/editor/previews/grace.h"

#include <utility>

namespace terrazzo {

GracePeriod::GracePeriod(std::chrono::milliseconds longest, std::chrono::milliseconds longest_shown)
    : longest_(longest), longest_shown_(longest_shown), thread_([this] { watch(); }) {}

GracePeriod::~GracePeriod() {
  {
    const std::lock_guard lock(mutex_);
    stops_ = cancelled_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void GracePeriod::begin() {
  const std::lock_guard lock(mutex_);
  begun_ = Clock::now();
  is_stale_ = is_shown_ = false;
  cancelled_ = stops_;
}

void GracePeriod::set_stale(bool is_stale) {
  {
    const std::lock_guard lock(mutex_);
    if (is_stale_ == is_stale) return;
    is_stale_ = is_stale;
  }
  changed_.notify_all();
}

void GracePeriod::shown() {
  {
    const std::lock_guard lock(mutex_);
    if (std::exchange(is_shown_, true)) return;
  }
  changed_.notify_all();
}

void GracePeriod::cancel() {
  const std::lock_guard lock(mutex_);
  cancelled_ = true;
}

void GracePeriod::watch() {
  std::unique_lock lock(mutex_);
  while (!stops_) {
    if (!is_stale_ || cancelled_) {
      changed_.wait(lock);
      continue;
    }
    const Clock::time_point end = begun_ + (is_shown_ ? longest_shown_ : longest_);
    if (Clock::now() >= end)
      cancelled_ = true;
    else
      changed_.wait_until(lock, end);
  }
}

}  // namespace terrazzo
