#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <set>
#include <thread>
#include <vector>

#include "runner/engine/jobs.h"

namespace terrazzo {

/// Holds jobs whose stage another process is computing, on its own thread, so that no worker waits. Polls after 5 ms,
/// then with exponential back-off up to 200 ms. The thread starts with the first job. All functions are thread-safe.
class LeaseWaiter {
 public:
  using Clock = std::chrono::steady_clock;
  static constexpr std::chrono::milliseconds first_pause{5}, longest_pause{200};
  /// Longest delay until cancellation is noticed.
  static constexpr std::chrono::milliseconds cancel_pause{50};

  /// Whether another process is still computing it. Called without locks; must not throw.
  using Taken = std::function<bool(const StageJob&)>;
  /// The time span of a wait.
  struct Wait {
    Clock::time_point start, end;
    int row = 0;  ///< for timelines: the lowest row that was free when the wait began
  };
  /// Receives a job back. Called once per job, without locks, on the waiter's thread; must not throw.
  using OnReady = std::function<void(StageJobPtr, const Wait&)>;

  /// `cancelled` may be null; once set, all jobs are returned.
  LeaseWaiter(Taken taken, OnReady give_back, const std::atomic<bool>* cancelled);
  /// Returns all jobs first.
  ~LeaseWaiter();
  LeaseWaiter(const LeaseWaiter&) = delete;
  LeaseWaiter& operator=(const LeaseWaiter&) = delete;

  void add(StageJobPtr job);
  /// Polls all jobs now, because a result has been stored.
  void look_now();
  /// Returns all jobs, including those added later: the run is ending.
  void give_all_back();

 private:
  struct Entry {
    StageJobPtr job;
    Wait wait;
    Clock::time_point due;
    Clock::duration pause;
  };

  void run();
  Clock::time_point next_look() const;
  std::vector<Entry> take_due(bool all);
  /// Hands over the jobs that need not wait; returns the others.
  std::vector<Entry> look_at(std::vector<Entry> due, bool give_all_back, std::vector<int>& free_rows);

  const Taken taken_;
  const OnReady on_ready_;
  const std::atomic<bool>* const cancelled_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<Entry> entries_;
  std::set<int> rows_;
  bool look_now_ = false;
  bool give_all_back_ = false;
  bool stop_ = false;
  std::thread thread_;
};

}  // namespace terrazzo
