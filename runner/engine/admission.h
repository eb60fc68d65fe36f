#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <vector>

#include "runner/engine/jobs.h"

namespace terrazzo {

/// For each stage the expected seconds of the longest path from it to a target, including itself, for critical-path
/// scheduling. A stage takes as long as its recorded result or its node's last run, else 1 second; 0 if the plan
/// expects no computation, or if the stage is lazy.
std::vector<double> remaining_seconds(const Plan& plan);

/// Decides which waiting jobs start, and when. Depends only on the order in which jobs arrive and end, not on a clock.
/// Not thread-safe.
///
/// - First come stores, since other processes wait for them and they hold values; then look-ups, which are quick and
///   show what there is to do; then loads and computations, those with the longest remaining path first. Ties go by
///   the order of the document.
/// - At most as many jobs run as there are threads.
/// - A computation starts while its expected memory, that of the running ones and that of the values in memory are
///   within the budget together, or while no other computation runs and nothing is being stored, which might free
///   memory. Loads wait while the budget is used up, unless
///   there is nothing else to do.
/// - A computation that has to wait for memory is passed by at most `patience` others. From then on no other one
///   starts, and nothing is loaded, until it has started.
class Admission {
 public:
  /// Higher keeps threads busy while a large job waits; lower keeps large jobs from coming last.
  static constexpr uint64_t patience = 8;

  /// `remaining`: see remaining_seconds. `memory`: the budget in bytes.
  Admission(std::vector<double> remaining, int threads, uint64_t memory)
      : remaining_(std::move(remaining)), threads_(threads), memory_(memory) {}

  void add(StageJobPtr job);
  /// The jobs to start now, given the bytes of values in memory.
  std::vector<StageJobPtr> admit(uint64_t held);
  /// The bytes by which the budget is exceeded now, or would be if the next computation started.
  uint64_t lacking(uint64_t held) const;
  uint64_t in_use() const { return in_use_; }
  /// An admitted job has ended.
  void ended(const StageJob& job);
  /// Drops waiting jobs.
  void forget_if(const std::function<bool(const StageJob&)>& unwanted);
  bool idle() const { return running_ == 0 && waiting_.empty(); }

 private:
  /// The order of waiting jobs.
  struct Rank {
    int urgency = 0;
    double remaining = 0;
    StageJob::Kind kind = StageJob::Kind::begin;
    int stage = 0;
    uint64_t arrival = 0;
    bool operator<(const Rank& other) const;
  };
  struct Waiting {
    StageJobPtr job;
    bool refused = false;
  };
  using Queue = std::map<Rank, Waiting>;
  /// A computation that had to wait for memory.
  struct Refusal {
    Rank rank;
    uint64_t computations_before = 0;
  };

  bool fits(const StageJob& job, uint64_t held) const;
  bool may_load(uint64_t held) const;
  bool may_start(const Queue::iterator& at, uint64_t held);
  bool overdue() const;
  Queue::iterator remove(Queue::iterator at);
  Queue::iterator start(Queue::iterator at, std::vector<StageJobPtr>& admitted);

  const std::vector<double> remaining_;
  const int threads_;
  const uint64_t memory_;
  Queue waiting_;
  std::vector<Refusal> refusals_;  ///< of waiting computations, the first one first
  uint64_t arrivals_ = 0;
  uint64_t computations_ = 0;  ///< that have started
  int waiting_computations_ = 0;
  int running_ = 0;
  int computing_ = 0;
  int storing_ = 0;
  uint64_t in_use_ = 0;  ///< bytes, expected, by running computations
};

}  // namespace terrazzo
