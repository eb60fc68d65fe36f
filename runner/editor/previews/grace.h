#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>

namespace terrazzo {

/// Whether work that a change has made stale may still end. Pictures follow a slider only if they are allowed to come
/// late: each change would cancel the work of the one before, and nothing would be seen until the slider rests. So
/// stale work goes on until it has shown something, but never longer than some time after it began. Thread-safe.
class GracePeriod {
 public:
  /// Work may take so long once it is stale, counted from its beginning; and so long if it has shown something.
  GracePeriod(std::chrono::milliseconds longest, std::chrono::milliseconds longest_shown);
  ~GracePeriod();
  GracePeriod(const GracePeriod&) = delete;
  GracePeriod& operator=(const GracePeriod&) = delete;

  void begin();
  /// The work that is under way is not wanted any more, or is wanted again.
  void set_stale(bool is_stale);
  /// Its result can be seen, or something like it.
  void shown();
  /// At once.
  void cancel();
  /// What the work has to watch.
  const std::atomic<bool>& cancelled() const { return cancelled_; }

 private:
  using Clock = std::chrono::steady_clock;
  void watch();

  const std::chrono::milliseconds longest_, longest_shown_;
  std::mutex mutex_;
  std::condition_variable changed_;
  Clock::time_point begun_{};
  bool is_stale_ = false, is_shown_ = false, stops_ = false;
  std::atomic<bool> cancelled_{false};
  std::thread thread_;
};

}  // namespace terrazzo
