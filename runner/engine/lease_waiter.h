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

/// Keeps jobs whose stage another process is computing until there is reason to try them again, on a thread of its own
/// that sleeps: no worker waits. It looks after 5 ms, and then after twice as long as the last time, up to 200 ms.
/// The thread starts with the first job. All functions are thread-safe.
class LeaseWaiter {
 public:
  using Clock = std::chrono::steady_clock;
  static constexpr std::chrono::milliseconds first_pause{5}, longest_pause{200};
  /// How soon it notices that the run has been cancelled.
  static constexpr std::chrono::milliseconds cancel_pause{50};

  /// Whether another process is still at it. Called without locks; must not throw.
  using Taken = std::function<bool(const Job&)>;
  /// How long a job has waited.
  struct Wait {
    Clock::time_point start, end;
    int row = 0;  ///< for drawings: the lowest number that no other waiting job had when it began
  };
  /// Takes a job back. Called without locks, once for every job, on the waiter's thread; must not throw.
  using GiveBack = std::function<void(JobPtr, const Wait&)>;

  /// `cancelled` may be null; once it is set all jobs are given back.
  LeaseWaiter(Taken taken, GiveBack give_back, const std::atomic<bool>* cancelled);
  /// Gives everything back first.
  ~LeaseWaiter();
  LeaseWaiter(const LeaseWaiter&) = delete;
  LeaseWaiter& operator=(const LeaseWaiter&) = delete;

  void add(JobPtr job);
  /// A result has been stored: looks at all jobs at once.
  void look_now();
  /// The run is coming to its end: gives all jobs back, those that are added later, too.
  void give_all_back();

 private:
  struct Entry {
    JobPtr job;
    Wait wait;
    Clock::time_point due;
    Clock::duration pause;
  };

  void run();
  Clock::time_point next_look() const;
  std::vector<Entry> take_due(bool all);
  /// Gives those back that need not wait; returns the others.
  std::vector<Entry> look_at(std::vector<Entry> due, bool give_all_back, std::vector<int>& free_rows);

  const Taken taken_;
  const GiveBack give_back_;
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
