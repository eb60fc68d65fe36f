#pragma once

#include <deque>
#include <set>
#include <string>
#include <unordered_map>

#include "runner/engine/admission.h"
#include "runner/engine/held_memory.h"
#include "runner/engine/jobs.h"
#include "runner/engine/outcomes.h"
#include "runner/engine/stage_state.h"

namespace terrazzo {

/// Holds the state of a run: takes finished jobs, one at a time, and returns the jobs that can start. Never blocks and
/// does no work itself. Not thread-safe.
///
/// The states of a stage are in runner/engine/stage_state.h, the order of jobs in runner/engine/admission.h. A stage
/// whose readers are all cached is never touched; readers of a stage with an unchanged result are cached.
class Coordinator {
 public:
  /// `threads`: number of workers; `memory`: the budget in bytes. Plan and options must outlive it.
  Coordinator(Plan& plan, const RunOptions& options, int threads, uint64_t memory);

  /// Processes a job that has ended, or that no longer waits for another process. Throws std::logic_error if the
  /// stage's state does not allow it.
  void settle(const StageJobPtr& job);
  /// The jobs to start now.
  std::vector<StageJobPtr> admit();
  /// The jobs that wait for another process. Settle each again, with `resumed` set, to retry it.
  std::vector<StageJobPtr> take_postponed() { return std::exchange(postponed_, {}); }

  /// No new computation starts: the run was cancelled, or a stage failed without `keep_going`.
  bool stopping() const { return cancelled_ || (outcomes_.any_failed() && !options_.targets.keep_going); }
  bool cancelled() const { return cancelled_; }
  Outcomes& outcomes() { return outcomes_; }
  std::map<std::string, std::map<std::string, Value>> take_kept();

  const StageStates& states() const { return states_; }
  /// Bytes of values in memory that wait for readers.
  uint64_t held_memory() const { return held_.bytes(); }
  /// The peak of the expected memory of held values and running computations, in bytes.
  uint64_t most_memory() const { return most_memory_; }

 private:
  /// Queued instead of called, as chains may be thousands of stages long.
  enum class Step : uint8_t { look_up, want_values, let_go, skip };

  void react(StageJob& job);
  void resume(const StageJobPtr& job);
  void put_off(Step step, int stage) { steps_.push_back({step, stage}); }
  void take_steps();
  void begin();
  void look_up(int stage);
  void resolved(int stage);
  void name(int stage, NameEvent event);
  void move(int stage, ValueEvent event);
  bool may_be_asked(int stage) const;
  void want_values(int stage);
  void ask_sources(int stage);
  void start_computing(int stage);
  void values_there(int stage, ValueEvent event);
  void loaded(StageJob& job);
  void computed(StageJob& job);
  void enqueue_store(const StageJob& job);
  void stored(StageJob& job);
  void let_go_if_unclaimed(int stage);
  void drop_values(int stage);
  bool may_be_spilled(int stage) const;
  void spill();
  void ask_for_spilled(int stage);
  void failed(const StageJob& job);
  void lose(int stage);
  void skip_if_lost(int stage);
  std::unique_ptr<NodeContext> make_context(int stage);
  void enqueue(StageJob::Kind kind, int stage);

  Plan& plan_;
  const RunOptions& options_;
  StageStates states_;
  Admission admission_;
  HeldMemory held_;
  Outcomes outcomes_;
  std::vector<std::map<std::string, Value>> values_;  ///< by stage and output port
  std::set<int> in_memory_and_cache_;                 ///< stages whose values are held and can be loaded again
  uint64_t most_memory_ = 0;
  std::vector<StageJobPtr> postponed_;
  std::deque<std::pair<Step, int>> steps_;
  std::unordered_map<std::string_view, int> places_;
  bool cancelled_ = false;
};

}  // namespace terrazzo
