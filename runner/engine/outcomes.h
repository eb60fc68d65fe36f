#pragma once

#include <set>
#include <string>
#include <vector>

#include "runner/engine/jobs.h"

namespace terrazzo {

/// What has become of the stages of a run: for its result, for the history, and for the observer, who hears of every
/// needed stage once whether it was computed or not. Not thread-safe.
class Outcomes {
 public:
  /// Both must outlive it.
  Outcomes(const Plan& plan, const RunOptions& options);

  /// The stage's key has been looked up.
  void looked_up(int stage);
  /// It is certain by now that the stage will not be computed for a reader. Later calls do nothing.
  void rests(int stage);
  /// A compute job succeeded, here or in another process.
  void computed(const Job& job);
  /// A job failed. What is wrong with an input is kept once, however many stages read it.
  void failed(const Job& job);
  /// A job ended, in whatever way.
  void ended(const Job& job);
  void add(const Span& span) { spans_.push_back(span); }

  bool any_failed() const { return !failures_.empty(); }

  std::vector<StageOutcome> take_stages() { return std::move(stages_); }
  std::vector<Failure> take_failures() { return std::move(failures_); }
  std::vector<Span> take_spans() { return std::move(spans_); }
  /// That nodes have made, whether they then succeeded or not; outer ones first.
  std::vector<std::filesystem::path> take_made_folders() { return std::move(made_folders_); }

 private:
  void note(int stage);

  const Plan& plan_;
  const RunOptions& options_;
  std::vector<StageOutcome> stages_;
  std::vector<bool> told_;  ///< the observer knows what became of the stage
  std::vector<Failure> failures_;
  std::set<std::string> blamed_inputs_;
  std::vector<Span> spans_;
  std::vector<std::filesystem::path> made_folders_;
};

}  // namespace terrazzo
