#pragma once

#include <set>
#include <string>
#include <vector>

#include "runner/engine/jobs.h"

namespace terrazzo {

/// Collects the outcomes of stages for the result, the history and the observer. Notifies the observer once per needed
/// stage. Not thread-safe.
class Outcomes {
 public:
  /// Both must outlive it.
  Outcomes(const Plan& plan, const RunOptions& options);

  /// The stage's key has been looked up.
  void looked_up(int stage);
  /// No reader will need the stage to be computed. Later calls do nothing.
  void rests(int stage);
  /// A compute job succeeded, here or in another process.
  void computed(const StageJob& job);
  /// A job failed. Problems of an input are recorded once, however many stages read it.
  void failed(const StageJob& job);
  /// The plan knows that the stage fails.
  void refused(int stage);
  /// The stage needs results of the stage `cause`, which has failed or was skipped itself.
  void skipped(int stage, int cause);
  /// A job ended, successfully or not.
  void ended(const StageJob& job);
  void add(const Span& span) { spans_.push_back(span); }

  bool any_failed() const { return !failures_.empty(); }

  std::vector<StageOutcome> take_stages() { return std::move(stages_); }
  std::vector<Failure> take_failures() { return std::move(failures_); }
  std::vector<Span> take_spans() { return std::move(spans_); }
  /// Folders created by nodes, including failed ones; outer ones first.
  std::vector<std::filesystem::path> take_made_folders() { return std::move(made_folders_); }

 private:
  void note(int stage);

  const Plan& plan_;
  const RunOptions& options_;
  std::vector<StageOutcome> stages_;
  std::vector<bool> notified_;  ///< the observer has been notified of the outcome
  std::vector<Failure> failures_;
  std::set<std::string> blamed_inputs_;
  std::vector<Span> spans_;
  std::vector<std::filesystem::path> made_folders_;
};

}  // namespace terrazzo
