#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <vector>

#include "runner/engine/jobs.h"

namespace terrazzo {

/// For each stage the seconds that the longest path from it to a target is expected to take, itself included: the
/// critical path is computed first. A stage is expected to take what it took when its result, or else its node's last
/// result, was computed; 1 second where neither is known, and nothing where the plan expects no computing or only a
/// recipe. `history` may be null.
std::vector<double> remaining_seconds(const Plan& plan, const History* history);

/// Decides which of the waiting jobs start, and when. The same jobs in the same order of arrival and of ending start in
/// the same order: no clock is asked. Not thread-safe.
///
/// - First come stores, since other processes wait for them and they hold values; then look-ups, which are quick and
///   show what there is to do; then loads and computations, those with the longest remaining path first. Ties go by
///   the order of the document.
/// - At most as many jobs run as there are threads.
/// - A computation starts while its expected memory, that of the running ones and that of the values in memory are
///   within the budget together, or while no other computation runs. Loads wait while the budget is used up, unless
///   there is nothing else to do.
/// - A computation that has to wait for memory is passed by at most `patience` others. From then on no other one
///   starts, and nothing is loaded, until it has started.
class Admission {
 public:
  /// High enough that a large job does not leave the other threads idle early; low enough that it is not left for last.
  static constexpr uint64_t patience = 8;

  /// `remaining`: see remaining_seconds. `memory`: the budget in bytes.
  Admission(std::vector<double> remaining, int threads, uint64_t memory)
      : remaining_(std::move(remaining)), threads_(threads), memory_(memory) {}

  void add(JobPtr job);
  /// The jobs to start now, given the bytes of values in memory.
  std::vector<JobPtr> admit(uint64_t held);
  /// One that was admitted has come to its end.
  void ended(const Job& job);
  /// Forgets waiting jobs.
  void forget_if(const std::function<bool(const Job&)>& unwanted);
  bool idle() const { return running_ == 0 && waiting_.empty(); }

 private:
  /// What decides who comes first.
  struct Rank {
    int urgency = 0;
    double remaining = 0;
    Job::Kind kind = Job::Kind::begin;
    int stage = 0;
    uint64_t arrival = 0;
    bool operator<(const Rank& other) const;
  };
  struct Waiting {
    JobPtr job;
    bool refused = false;
  };
  using Queue = std::map<Rank, Waiting>;
  /// A computation for which there was no memory.
  struct Refusal {
    Rank rank;
    uint64_t computations_before = 0;
  };

  bool fits(const Job& job, uint64_t held) const;
  bool may_load(uint64_t held) const;
  bool may_start(const Queue::iterator& at, uint64_t held);
  bool overdue() const;
  Queue::iterator remove(Queue::iterator at);
  Queue::iterator start(Queue::iterator at, std::vector<JobPtr>& admitted);

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
  uint64_t in_use_ = 0;  ///< by computations, expected
};

}  // namespace terrazzo
