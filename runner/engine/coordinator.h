#pragma once

#include <deque>
#include <set>
#include <string>
#include <unordered_map>

#include "runner/engine/jobs.h"

namespace terrazzo {

/// Decides what is done next. It holds the state of a run and is told of every finished job, one at a time; it answers
/// with the jobs that can start now. It never blocks and does no work of its own.
///
/// Names flow forward: as soon as all inputs of a stage have names, its key is looked up. Values are made on demand,
/// backward: a stage that has to run asks its sources for values, and they load them, compute them, or have them. So a
/// stage whose readers are all cached is never touched, and readers of a stage that comes out as before are cached.
class Coordinator {
 public:
  Coordinator(Plan& plan, const RunOptions& options, int threads, uint64_t memory);

  /// Takes note of a finished job.
  void settle(Job& job);
  /// The jobs to start now.
  std::vector<JobPtr> admit();

  std::vector<StageOutcome> take_outcomes() { return std::move(outcomes_); }
  std::vector<Failure> take_failures() { return std::move(failures_); }
  std::vector<Span> take_spans() { return std::move(spans_); }
  /// That nodes have made, whether they then succeeded or not; outer ones first.
  std::vector<std::filesystem::path> take_made_folders() { return std::move(made_folders_); }
  std::map<std::string, std::map<std::string, Value>> take_kept();
  bool cancelled() const { return cancelled_; }

 private:
  struct Live {
    int unnamed_sources = 0;
    int awaited_sources = 0;  ///< of which it still needs values before it can be computed
    int open_readers = 0;     ///< that may still ask for its values
    bool settled = false;     ///< its outputs have names
    bool wanted = false;      ///< its values have been asked for and are on their way
    bool awaiting = false;    ///< it waits for its sources' values
    bool closed = false;      ///< it will not ask for its sources' values any more
    bool told = false;        ///< the observer knows what became of it
    std::map<std::string, Value> values;
  };

  /// What one thing leads to. Put off instead of called: it may go on along thousands of stages.
  enum class Step : uint8_t { look_up, want_values, release_if_unread };

  void react(Job& job);
  void put_off(Step step, int stage) { steps_.push_back({step, stage}); }
  void take_steps();
  void begin();
  void look_up(int stage);
  void resolved(int stage);
  void named(int stage);
  void want_values(int stage);
  void compute(int stage);
  void enqueue_compute(int stage);
  void values_there(int stage);
  void loaded(Job& job);
  void computed(Job& job);
  void enqueue_store(const Job& job);
  void close(int stage);
  void reopen(int stage);
  void release_if_unread(int stage);
  void tell_not_run(int stage);
  bool may_be_asked(int stage) const;
  bool has_values(int stage) const;
  std::unique_ptr<NodeContext> make_context(int stage);
  void enqueue(Job::Kind kind, int stage);
  bool stopping() const { return cancelled_ || !failures_.empty(); }

  Plan& plan_;
  const RunOptions& options_;
  const int max_running_;
  const uint64_t memory_;
  std::vector<Live> live_;
  std::vector<StageOutcome> outcomes_;
  std::vector<Failure> failures_;
  std::set<std::string> blamed_inputs_;
  std::vector<Span> spans_;
  std::vector<std::filesystem::path> made_folders_;
  std::deque<JobPtr> waiting_;
  std::deque<std::pair<Step, int>> steps_;
  std::unordered_map<std::string_view, int> places_;
  int running_ = 0;
  int computing_ = 0;
  uint64_t memory_in_use_ = 0;
  bool cancelled_ = false;
};

}  // namespace terrazzo
