#include "runner/engine/coordinator.h"

#include <algorithm>
#include <utility>

#include "runner/engine/history.h"

namespace terrazzo {

namespace {

uint64_t expected_memory(const NodeContext& context) {
  if (!context.type().memory_hint) return 0;
  try {
    return context.type().memory_hint(context);
  } catch (const Error&) {
    return 0;  // inputs that the node will refuse
  }
}

}  // namespace

Coordinator::Coordinator(Plan& plan, const RunOptions& options, int threads, uint64_t memory)
    : plan_(plan), options_(options), max_running_(threads), memory_(memory), live_(plan.stages.size()) {
  for (size_t i = 0; i < plan.stages.size(); i++) {
    const Stage& s = plan.stages[i];
    places_[s.node->name] = static_cast<int>(i);
    live_[i].unnamed_sources = static_cast<int>(s.sources.size());
    live_[i].open_readers = static_cast<int>(s.readers.size());
    StageOutcome outcome;
    outcome.node = s.node->name;
    outcome.kind = s.expected() ? StageOutcome::Kind::unfinished : StageOutcome::Kind::idle;
    outcomes_.push_back(outcome);
  }
}

void Coordinator::begin() {
  for (size_t i = 0; i < plan_.stages.size(); i++)
    if (plan_.stages[i].needed && plan_.stages[i].sources.empty()) look_up(static_cast<int>(i));
}

/// All its inputs have names.
void Coordinator::look_up(int stage) {
  if (plan_.stages[stage].known)
    resolved(stage);
  else
    enqueue(Job::Kind::look_up, stage);
}

void Coordinator::resolved(int stage) {
  const Stage& s = plan_.stages[stage];
  StageOutcome& outcome = outcomes_[stage];
  if (s.known->record) {
    outcome.notes = s.known->record->notes;
    outcome.files = s.known->record->files;
  }
  if (!s.known->must_run.empty()) {
    live_[stage].wanted = true;
    if (!s.known->names.empty()) named(stage);
    compute(stage);
    return;
  }
  if (s.known->record) {
    outcome.kind = StageOutcome::Kind::reused;
    if (options_.history) options_.history->remember(s.node->name, s.known->ingredients);
  } else {
    outcome.kind = StageOutcome::Kind::idle;
  }
  // A plan gives no reason for what nobody is going to ask for, unless a stored result turns out damaged.
  const bool at_rest = !may_be_asked(stage), planned_to_rest = s.reason.empty();
  if (at_rest || planned_to_rest) tell_not_run(stage);
  if (at_rest) close(stage);
  named(stage);
  if (s.kept) want_values(stage);
}

/// It is certain by now that it will not be computed for a reader.
void Coordinator::tell_not_run(int stage) {
  if (std::exchange(live_[stage].told, true) || !options_.observer) return;
  const Stage& s = plan_.stages[stage];
  if (outcomes_[stage].kind != StageOutcome::Kind::reused) return options_.observer->spared(s);
  options_.observer->reused(s);
  for (const std::string& note : outcomes_[stage].notes) options_.observer->noted(s, note);
}

/// Its outputs have names: its readers may know all of theirs now.
void Coordinator::named(int stage) {
  if (live_[stage].settled) return;
  live_[stage].settled = true;
  for (const int reader : plan_.stages[stage].readers)
    if (--live_[reader].unnamed_sources == 0) put_off(Step::look_up, reader);
}

bool Coordinator::has_values(int stage) const {
  const Live& l = live_[stage];
  return std::all_of(plan_.stages[stage].used_outputs.begin(), plan_.stages[stage].used_outputs.end(),
                     [&](const std::string& port) { return l.values.count(port) == 1; });
}

/// Whether a stage that need not run by itself might have to compute for a reader.
bool Coordinator::may_be_asked(int stage) const {
  const Stage& s = plan_.stages[stage];
  const bool loadable = s.known->record && s.type().persist == Persist::payload && s.known->stored;
  return !loadable && (live_[stage].open_readers > 0 || s.kept);
}

void Coordinator::want_values(int stage) {
  Live& l = live_[stage];
  if (l.wanted || has_values(stage)) return;
  l.wanted = true;
  const Stage& s = plan_.stages[stage];
  if (s.known->record && s.type().persist == Persist::payload && s.known->stored)
    enqueue(Job::Kind::load, stage);
  else
    compute(stage);
}

void Coordinator::compute(int stage) {
  Live& l = live_[stage];
  reopen(stage);
  l.awaiting = true;
  l.awaited_sources = 0;
  for (const int source : plan_.stages[stage].sources)
    if (!has_values(source)) l.awaited_sources++;
  if (l.awaited_sources == 0) return enqueue_compute(stage);
  for (const int source : plan_.stages[stage].sources)
    if (!has_values(source)) put_off(Step::want_values, source);
}

void Coordinator::enqueue_compute(int stage) {
  live_[stage].awaiting = false;
  enqueue(Job::Kind::compute, stage);
}

void Coordinator::values_there(int stage) {
  live_[stage].wanted = false;
  for (const int reader : plan_.stages[stage].readers)
    if (live_[reader].awaiting && --live_[reader].awaited_sources == 0) enqueue_compute(reader);
}

void Coordinator::loaded(Job& job) {
  const int stage = job.stage;
  if (job.values.empty()) {
    plan_.stages[stage].known->stored = false;
    return compute(stage);
  }
  live_[stage].values = std::move(job.values);
  values_there(stage);
  release_if_unread(stage);
}

void Coordinator::computed(Job& job) {
  const int stage = job.stage;
  Stage& s = plan_.stages[stage];
  StageOutcome& outcome = outcomes_[stage];
  outcome.kind = job.made_elsewhere ? StageOutcome::Kind::reused : StageOutcome::Kind::run;
  if (!job.made_elsewhere) outcome.seconds += job.record->seconds;
  outcome.notes = job.record->notes;
  outcome.files = job.record->files;
  if (job.made_elsewhere) {
    tell_not_run(stage);
  } else if (options_.observer) {
    options_.observer->finished(s, job.record->seconds);
    if (!std::exchange(live_[stage].told, true))
      for (const std::string& note : outcome.notes) options_.observer->noted(s, note);
  }
  if (options_.history) options_.history->remember(s.node->name, s.known->ingredients);
  if (options_.cache && !job.made_elsewhere) enqueue_store(job);
  if (s.known->names.empty()) s.known->names = job.record->outputs;
  live_[stage].values = std::move(job.values);
  std::erase_if(live_[stage].values, [&](const auto& value) {
    return std::find(s.used_outputs.begin(), s.used_outputs.end(), value.first) == s.used_outputs.end();
  });
  named(stage);
  values_there(stage);
  close(stage);
  release_if_unread(stage);
}

void Coordinator::enqueue_store(const Job& job) {
  const Stage& s = plan_.stages[job.stage];
  const bool payload = s.type().persist == Persist::payload;
  const bool known = s.known->record && s.known->record->files.empty() && s.known->must_run.empty();
  if (known && (!payload || s.known->stored)) return;
  auto store = std::make_shared<Job>();
  store->kind = Job::Kind::store;
  store->stage = job.stage;
  if (payload) store->values = job.values;
  store->record = job.record;
  store->lease = job.lease;
  waiting_.push_front(store);  // others may wait for it
}

/// It will not ask for its sources' values again.
void Coordinator::close(int stage) {
  if (live_[stage].closed) return;
  live_[stage].closed = true;
  for (const int source : plan_.stages[stage].sources) {
    live_[source].open_readers--;
    put_off(Step::release_if_unread, source);
  }
}

/// It asks for its sources' values after all: a stored result could not be read.
void Coordinator::reopen(int stage) {
  if (!live_[stage].closed) return;
  live_[stage].closed = false;
  for (const int source : plan_.stages[stage].sources) live_[source].open_readers++;
}

/// Lets values go after their last reader, and with them the claim on the values they would be made from.
void Coordinator::release_if_unread(int stage) {
  Live& l = live_[stage];
  const Stage& s = plan_.stages[stage];
  if (l.open_readers > 0 || s.kept) return;
  l.values.clear();
  const bool at_rest = s.known && s.known->must_run.empty() && !l.wanted && !l.awaiting;
  if (!at_rest || !l.settled) return;
  tell_not_run(stage);
  close(stage);
}

std::unique_ptr<NodeContext> Coordinator::make_context(int stage) {
  const Stage& s = plan_.stages[stage];
  std::map<std::string, std::vector<Value>> inputs;
  for (const auto& [port, wires] : s.node->inputs)
    for (const Wire& w : wires)
      inputs[port].push_back(converted(live_[places_.at(w.node)].values.at(w.port), s.type().find_input(port)->type));
  RunObserver* observer = options_.observer;
  std::function<void(double)> progress;
  if (observer) progress = [observer, &s](double fraction) { observer->progressed(s, fraction); };
  return std::make_unique<NodeContext>(s.type(), s.node->params, std::move(inputs), s.known->key,
                                       Task(options_.cancelled, std::move(progress)));
}

void Coordinator::enqueue(Job::Kind kind, int stage) {
  auto job = std::make_shared<Job>();
  job->kind = kind;
  job->stage = stage;
  if (kind == Job::Kind::compute) {
    job->context = make_context(stage);
    job->memory = expected_memory(*job->context);
  }
  waiting_.push_back(std::move(job));
}

void Coordinator::settle(Job& job) {
  if (job.kind != Job::Kind::begin) running_--;
  if (job.kind == Job::Kind::compute) {
    computing_--;
    memory_in_use_ -= job.memory;
  }
  made_folders_.insert(made_folders_.end(), job.made_folders.begin(), job.made_folders.end());
  if (job.busy) job.span.what = "wait";
  if (job.span.end > 0) spans_.push_back(job.span);
  if (job.cancelled || (options_.cancelled && options_.cancelled->load())) cancelled_ = true;
  if (job.failure) {
    if (job.blames_input.empty() || blamed_inputs_.insert(job.blames_input).second)
      failures_.push_back({plan_.stages[job.stage].node->name, *job.failure});
    outcomes_[job.stage].kind = StageOutcome::Kind::failed;
    if (options_.observer) options_.observer->failed(plan_.stages[job.stage], *job.failure);
  }
  if (job.failure || job.cancelled) return;
  if (job.busy) {
    job.busy = false;
    waiting_.push_back(std::make_shared<Job>(std::move(job)));
    return;
  }
  react(job);
  take_steps();
}

void Coordinator::take_steps() {
  while (!steps_.empty()) {
    const auto [step, stage] = steps_.front();
    steps_.pop_front();
    switch (step) {
      case Step::look_up:
        look_up(stage);
        break;
      case Step::want_values:
        want_values(stage);
        break;
      case Step::release_if_unread:
        release_if_unread(stage);
        break;
    }
  }
}

void Coordinator::react(Job& job) {
  switch (job.kind) {
    case Job::Kind::begin:
      return begin();
    case Job::Kind::look_up:
      plan_.stages[job.stage].known = std::move(job.resolution);
      return resolved(job.stage);
    case Job::Kind::load:
      return loaded(job);
    case Job::Kind::compute:
      return computed(job);
    case Job::Kind::store:
      return;
  }
}

std::vector<JobPtr> Coordinator::admit() {
  if (stopping())
    // What has been computed is still put into the cache, unless the user is in a hurry.
    std::erase_if(waiting_, [&](const JobPtr& j) { return cancelled_ || j->kind != Job::Kind::store; });
  std::vector<JobPtr> admitted;
  for (auto at = waiting_.begin(); at != waiting_.end() && running_ < max_running_;) {
    Job& job = **at;
    const bool compute = job.kind == Job::Kind::compute;
    const bool too_large = compute && computing_ > 0 && memory_in_use_ + job.memory > memory_;
    // To wait for another process takes a thread, so it is done while there is nothing else to do.
    if (too_large || (job.waited && running_ > 0)) {
      ++at;
      continue;
    }
    running_++;
    if (compute) {
      computing_++;
      memory_in_use_ += job.memory;
    }
    admitted.push_back(std::move(*at));
    at = waiting_.erase(at);
  }
  return admitted;
}

std::map<std::string, std::map<std::string, Value>> Coordinator::take_kept() {
  std::map<std::string, std::map<std::string, Value>> kept;
  for (size_t i = 0; i < live_.size(); i++)
    if (plan_.stages[i].kept) kept[plan_.stages[i].node->name] = std::move(live_[i].values);
  return kept;
}

}  // namespace terrazzo
