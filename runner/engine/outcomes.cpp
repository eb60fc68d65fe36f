#include "runner/engine/outcomes.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "runner/plan/history.h"

namespace terrazzo {

Outcomes::Outcomes(const Plan& plan, const RunOptions& options)
    : plan_(plan), options_(options), notified_(plan.stages.size(), false) {
  for (const Stage& s : plan.stages) {
    StageOutcome outcome;
    outcome.node = s.node->name;
    outcome.kind = s.expected() ? StageOutcome::Kind::unfinished : StageOutcome::Kind::idle;
    stages_.push_back(outcome);
  }
}

void Outcomes::looked_up(int stage) {
  const Stage& s = plan_.stages[stage];
  StageOutcome& outcome = stages_[stage];
  const std::optional<StageRecord>& record = s.known->record;
  if (record) {
    outcome.notes = record->notes;
    outcome.files = record->files;
  }
  outcome.reason = s.known->must_run;
  outcome.key = s.known->key;
  outcome.outputs = s.known->names;
  if (!s.known->must_run.empty()) return;
  outcome.kind = record ? StageOutcome::Kind::reused : StageOutcome::Kind::idle;
  if (record && options_.history) options_.history->remember(s.node->name, s.known->ingredients, record->seconds);
}

void Outcomes::note(int stage) {
  for (const std::string& note : stages_[stage].notes) options_.observer->noted(plan_.stages[stage], note);
}

void Outcomes::rests(int stage) {
  if (notified_[stage]) return;
  notified_[stage] = true;
  if (!options_.observer) return;
  if (stages_[stage].kind != StageOutcome::Kind::reused) return options_.observer->not_needed(plan_.stages[stage]);
  options_.observer->reused(plan_.stages[stage]);
  note(stage);
}

void Outcomes::computed(const StageJob& job) {
  const Stage& s = plan_.stages[job.stage];
  StageOutcome& outcome = stages_[job.stage];
  outcome.kind = job.computed_remotely ? StageOutcome::Kind::reused : StageOutcome::Kind::run;
  outcome.notes = job.record->notes;
  outcome.files = job.record->files;
  outcome.outputs = job.record->outputs;
  if (job.computed_remotely) {
    rests(job.stage);
  } else {
    outcome.seconds += job.record->seconds;
    if (options_.observer) options_.observer->finished(s, job.record->seconds);
    if (options_.observer && !notified_[job.stage]) note(job.stage);
    notified_[job.stage] = true;
  }
  if (options_.history) options_.history->remember(s.node->name, s.known->ingredients, job.record->seconds);
}

void Outcomes::failed(const StageJob& job) {
  if (job.blames_input.empty() || blamed_inputs_.insert(job.blames_input).second)
    failures_.push_back({job.blames_node.empty() ? plan_.stages[job.stage].node->name : job.blames_node, *job.failure});
  stages_[job.stage].kind = StageOutcome::Kind::failed;
  if (options_.observer) options_.observer->failed(plan_.stages[job.stage], *job.failure);
}

void Outcomes::refused(int stage) {
  const Stage& s = plan_.stages[stage];
  for (const std::string& fault : s.faults) failures_.push_back({s.node->name, fault});
  stages_[stage].kind = StageOutcome::Kind::failed;
  if (options_.observer) options_.observer->failed(s, fmt::format("{}", fmt::join(s.faults, "\n")));
}

void Outcomes::skipped(int stage, int cause) {
  const StageOutcome& from = stages_[cause];
  StageOutcome& outcome = stages_[stage];
  outcome.because = from.kind == StageOutcome::Kind::skipped ? from.because : from.node;
  outcome.kind = StageOutcome::Kind::skipped;
  if (options_.observer) options_.observer->skipped(plan_.stages[stage], outcome.because);
}

void Outcomes::ended(const StageJob& job) {
  made_folders_.insert(made_folders_.end(), job.made_folders.begin(), job.made_folders.end());
  if (job.span.end > 0 && !job.busy) spans_.push_back(job.span);
}

}  // namespace terrazzo
