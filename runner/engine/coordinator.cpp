#include "runner/engine/coordinator.h"

#include <algorithm>
#include <mutex>
#include <utility>

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

/// Reports a stage's progress, which must never decrease: threads that share the work, and the second pass of a checked
/// run, start at 0 again.
std::function<void(double)> progress_of(const Stage& stage, RunObserver& observer) {
  struct Told {
    std::mutex mutex;
    double most = -1;
  };
  return [&stage, &observer, told = std::make_shared<Told>()](double fraction) {
    const std::lock_guard lock(told->mutex);
    if (fraction < told->most) return;
    told->most = fraction;
    observer.progressed(stage, fraction);
  };
}

}  // namespace

Coordinator::Coordinator(Plan& plan, const RunOptions& options, int threads, uint64_t memory)
    : plan_(plan),
      options_(options),
      states_(plan),
      admission_(remaining_seconds(plan), threads, memory),
      held_(plan.stages.size()),
      outcomes_(plan, options),
      values_(plan.stages.size()) {
  for (size_t i = 0; i < plan.stages.size(); i++) places_[plan.stages[i].node->name] = static_cast<int>(i);
}

void Coordinator::begin() {
  for (size_t i = 0; i < plan_.stages.size(); i++)
    if (plan_.stages[i].needed && plan_.stages[i].sources.empty()) look_up(static_cast<int>(i));
}

void Coordinator::look_up(int stage) {
  name(stage, NameEvent::inputs_named);
  const Stage& s = plan_.stages[stage];
  if (!s.faults.empty()) {
    outcomes_.refused(stage);
    return lose(stage);
  }
  if (s.known && !is_being_made(s, *s.known, options_))
    resolved(stage);
  else
    enqueue(StageJob::Kind::look_up, stage);
}

void Coordinator::resolved(int stage) {
  const Stage& s = plan_.stages[stage];
  outcomes_.looked_up(stage);
  if (!s.known->must_run.empty()) {
    name(stage, s.known->names.empty() ? NameEvent::not_found : NameEvent::found);
    move(stage, ValueEvent::compute);
    return ask_sources(stage);
  }
  name(stage, NameEvent::found);
  // A plan has no reason for stages that no one needs unless a stored result is damaged.
  const bool at_rest = !may_be_asked(stage), planned_to_rest = s.reason.empty();
  if (at_rest || planned_to_rest) outcomes_.rests(stage);
  if (at_rest) move(stage, ValueEvent::rest);
  if (s.kept && !s.used_outputs.empty()) want_values(stage);
}

/// Changes the state of a stage's names. Once it is named, its readers may know all their inputs.
void Coordinator::name(int stage, NameEvent event) {
  states_.advance(stage, event);
  if (states_.name(stage) != NameState::named) return;
  for (const int reader : plan_.stages[stage].readers)
    if (states_.inputs_named(reader)) put_off(Step::look_up, reader);
}

/// Changes the state of a stage's values. Once it no longer needs its sources' values, they may be dropped.
void Coordinator::move(int stage, ValueEvent event) {
  const bool claimed = claims_sources(states_.value(stage));
  states_.advance(stage, event);
  if (!claimed || claims_sources(states_.value(stage))) return;
  for (const int source : plan_.stages[stage].sources) put_off(Step::let_go, source);
}

/// Whether a stage that need not run by itself might have to compute for a reader.
bool Coordinator::may_be_asked(int stage) const {
  return states_.claimed(stage) && !plan_.stages[stage].loadable();
}

void Coordinator::want_values(int stage) {
  const ValueState now = states_.value(stage);
  if (now != ValueState::open && now != ValueState::resting) return;  // being computed or loaded, or in memory
  if (plan_.stages[stage].loadable()) {
    move(stage, ValueEvent::load);
    return enqueue(StageJob::Kind::load, stage);
  }
  move(stage, ValueEvent::compute);
  ask_sources(stage);
}

void Coordinator::ask_sources(int stage) {
  const std::vector<int>& sources = plan_.stages[stage].sources;
  if (std::any_of(sources.begin(), sources.end(), [&](int s) { return states_.value(s) == ValueState::lost; }))
    return put_off(Step::skip, stage);
  if (states_.inputs_held(stage)) return start_computing(stage);
  for (const int source : sources)
    if (states_.value(source) != ValueState::held) put_off(Step::want_values, source);
}

void Coordinator::start_computing(int stage) {
  move(stage, ValueEvent::inputs_held);
  enqueue(StageJob::Kind::compute, stage);
}

/// Called when a stage's values are in memory.
void Coordinator::values_there(int stage, ValueEvent event) {
  move(stage, event);
  for (const int reader : plan_.stages[stage].readers) {
    if (states_.value(reader) != ValueState::awaiting) continue;
    if (states_.inputs_held(reader))
      start_computing(reader);
    else
      ask_for_spilled(reader);
  }
  let_go_if_unclaimed(stage);
}

/// Reloads dropped values for a waiting stage once nothing else must be computed for it. Earlier they would only be
/// dropped again.
void Coordinator::ask_for_spilled(int stage) {
  const std::vector<int>& sources = plan_.stages[stage].sources;
  const auto rests = [&](int s) { return states_.value(s) == ValueState::resting; };
  const auto comes = [&](int s) {
    return states_.value(s) == ValueState::held || states_.value(s) == ValueState::loading;
  };
  if (!std::all_of(sources.begin(), sources.end(), [&](int s) { return rests(s) || comes(s); })) return;
  for (const int source : sources)
    if (rests(source)) put_off(Step::want_values, source);
}

/// Whether a stage's values can be dropped and loaded again: no reader computes with them or is about to.
bool Coordinator::may_be_spilled(int stage) const {
  const Stage& s = plan_.stages[stage];
  return states_.value(stage) == ValueState::held && !s.kept && s.loadable() &&
         std::none_of(s.readers.begin(), s.readers.end(), [&](int reader) {
           return states_.value(reader) == ValueState::computing || states_.gathers(reader);
         });
}

/// Drops values that are in the cache until the next job fits into the budget, largest first.
void Coordinator::spill() {
  while (admission_.lacking(held_.bytes()) > 0) {
    int largest = -1;
    uint64_t most = 0;
    for (const int stage : in_memory_and_cache_)
      if (const uint64_t bytes = held_.bytes_freed_by(stage); bytes > most && may_be_spilled(stage))
        largest = stage, most = bytes;
    if (largest < 0) return;
    drop_values(largest);
  }
}

void Coordinator::drop_values(int stage) {
  values_[stage].clear();
  held_.release(stage);
  in_memory_and_cache_.erase(stage);
  move(stage, ValueEvent::let_go);
}

void Coordinator::loaded(StageJob& job) {
  if (!job.values.empty()) {
    values_[job.stage] = std::move(job.values);
    held_.hold_loaded(job.stage, values_[job.stage]);
    in_memory_and_cache_.insert(job.stage);
    return values_there(job.stage, ValueEvent::read);
  }
  plan_.stages[job.stage].known->stored = false;
  move(job.stage, ValueEvent::unreadable);
  ask_sources(job.stage);
}

void Coordinator::computed(StageJob& job) {
  Stage& s = plan_.stages[job.stage];
  outcomes_.computed(job);
  if (options_.cache && !job.computed_remotely) enqueue_store(job);
  if (s.known->names.empty()) s.known->names = job.record->outputs;
  if (states_.name(job.stage) == NameState::nameless) name(job.stage, NameEvent::computed);
  std::map<std::string, Value>& values = values_[job.stage] = std::move(job.values);
  std::erase_if(values, [&](const auto& value) {
    return std::find(s.used_outputs.begin(), s.used_outputs.end(), value.first) == s.used_outputs.end();
  });
  if (job.computed_remotely)
    held_.hold_loaded(job.stage, values);
  else
    held_.hold_computed(job.stage, values, s.sources);
  values_there(job.stage, ValueEvent::computed);
}

void Coordinator::enqueue_store(const StageJob& job) {
  const Stage& s = plan_.stages[job.stage];
  const bool payload = s.type().persist == Persist::payload;
  const bool known = s.known->record && s.known->record->files.empty() && s.known->must_run.empty();
  if (known && (!payload || s.known->stored)) return;
  auto store = std::make_shared<StageJob>();
  store->kind = StageJob::Kind::store;
  store->stage = job.stage;
  if (payload) store->values = job.values;
  store->record = job.record;
  store->lease = job.lease;
  admission_.add(std::move(store));
}

void Coordinator::stored(StageJob& job) {
  if (!job.stored) return;
  Resolution& known = *plan_.stages[job.stage].known;
  known.record = std::move(job.record);
  known.stored = true;
  if (states_.value(job.stage) == ValueState::held) in_memory_and_cache_.insert(job.stage);
}

/// Drops values after their last reader, and with them the claim on their sources' values.
void Coordinator::let_go_if_unclaimed(int stage) {
  if (states_.claimed(stage)) return;
  if (states_.value(stage) == ValueState::held) {
    drop_values(stage);
  } else if (states_.value(stage) == ValueState::open && states_.name(stage) == NameState::named) {
    outcomes_.rests(stage);
    move(stage, ValueEvent::rest);
  }
}

std::unique_ptr<NodeContext> Coordinator::make_context(int stage) {
  const Stage& s = plan_.stages[stage];
  std::map<std::string, std::vector<Value>> inputs;
  for (const auto& [port, wires] : s.node->inputs)
    for (const Wire& w : wires)
      inputs[port].push_back(converted(values_[places_.at(w.node)].at(w.port), s.type().find_input(port)->type));
  RunObserver* observer = options_.observer;
  std::function<void(double)> progress;
  if (observer) progress = progress_of(s, *observer);
  Task::Preview preview;
  if (observer && observer->wants_previews())
    preview = [&s, observer](const UvMapPtr& coarse) { observer->previewed(s, coarse); };
  return std::make_unique<NodeContext>(s.type(), s.node->params, std::move(inputs), s.known->key,
                                       Task(options_.cancelled, std::move(progress), std::move(preview)));
}

void Coordinator::enqueue(StageJob::Kind kind, int stage) {
  auto job = std::make_shared<StageJob>();
  job->kind = kind;
  job->stage = stage;
  if (kind == StageJob::Kind::compute) {
    job->context = make_context(stage);
    job->memory = expected_memory(*job->context);
  }
  admission_.add(std::move(job));
}

void Coordinator::settle(const StageJobPtr& job) {
  if (options_.cancelled && options_.cancelled->load()) cancelled_ = true;
  if (job->resumed) return resume(job);
  if (job->kind != StageJob::Kind::begin) admission_.ended(*job);
  outcomes_.ended(*job);
  if (job->cancelled) cancelled_ = true;
  if (job->failure) return failed(*job);
  if (job->cancelled) return;
  if (job->busy) {
    if (job->kind == StageJob::Kind::compute) move(job->stage, ValueEvent::busy);
    if (!stopping()) postponed_.push_back(job);
    return;
  }
  react(*job);
  take_steps();
}

/// If storing fails, the stage's values are still valid.
void Coordinator::failed(const StageJob& job) {
  outcomes_.failed(job);
  if (stopping() || job.kind == StageJob::Kind::store) return;
  lose(job.stage);
  take_steps();
}

/// A stage's values are lost. Skips readers that need them; others have cached results.
void Coordinator::lose(int stage) {
  move(stage, ValueEvent::give_up);
  for (const int reader : plan_.stages[stage].readers) put_off(Step::skip, reader);
}

void Coordinator::skip_if_lost(int stage) {
  const std::vector<int>& sources = plan_.stages[stage].sources;
  const ValueState now = states_.value(stage);
  const NameState name = states_.name(stage);
  const auto needs = [&](int source) {
    const bool nameless = states_.name(source) != NameState::named;
    return states_.value(source) == ValueState::lost &&
           (now == ValueState::awaiting || (name == NameState::unknown && nameless));
  };
  const auto cause = std::find_if(sources.begin(), sources.end(), needs);
  if (cause == sources.end() || now == ValueState::lost) return;
  outcomes_.skipped(stage, *cause);
  lose(stage);
}

/// Puts the job behind those that have arrived meanwhile.
void Coordinator::resume(const StageJobPtr& job) {
  outcomes_.add(job->span);
  job->resumed = job->busy = false;
  if (!stopping()) admission_.add(job);
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
      case Step::let_go:
        let_go_if_unclaimed(stage);
        break;
      case Step::skip:
        skip_if_lost(stage);
        break;
    }
  }
}

void Coordinator::react(StageJob& job) {
  switch (job.kind) {
    case StageJob::Kind::begin:
      return begin();
    case StageJob::Kind::look_up:
      plan_.stages[job.stage].known = std::move(job.resolution);
      return resolved(job.stage);
    case StageJob::Kind::load:
      return loaded(job);
    case StageJob::Kind::compute:
      return computed(job);
    case StageJob::Kind::store:
      return stored(job);
  }
}

std::vector<StageJobPtr> Coordinator::admit() {
  if (stopping())
    // Computed results are still stored, unless the run was cancelled.
    admission_.forget_if([&](const StageJob& j) { return cancelled_ || j.kind != StageJob::Kind::store; });
  else
    spill();
  std::vector<StageJobPtr> admitted = admission_.admit(held_.bytes());
  most_memory_ = std::max(most_memory_, held_.bytes() + admission_.in_use());
  return admitted;
}

std::map<std::string, std::map<std::string, Value>> Coordinator::take_kept() {
  std::map<std::string, std::map<std::string, Value>> kept;
  for (size_t i = 0; i < values_.size(); i++)
    if (plan_.stages[i].kept) kept[plan_.stages[i].node->name] = std::move(values_[i]);
  return kept;
}

}  // namespace terrazzo
