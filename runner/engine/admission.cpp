#include "runner/engine/admission.h"

#include <algorithm>
#include <tuple>

namespace terrazzo {

namespace {

/// Jobs that need no memory come first.
constexpr int urgency_of_values = 2;

int urgency_of(StageJob::Kind kind) {
  switch (kind) {
    case StageJob::Kind::begin:
    case StageJob::Kind::store:
      return 0;
    case StageJob::Kind::look_up:
      return 1;
    case StageJob::Kind::load:
    case StageJob::Kind::compute:
      break;
  }
  return urgency_of_values;
}

}  // namespace

std::vector<double> remaining_seconds(const Plan& plan) {
  std::vector<double> remaining(plan.stages.size(), 0);
  for (size_t i = remaining.size(); i-- > 0;) {
    for (const int reader : plan.stages[i].readers) remaining[i] = std::max(remaining[i], remaining[reader]);
    remaining[i] += plan.stages[i].expected_seconds;
  }
  return remaining;
}

bool Admission::Rank::operator<(const Rank& other) const {
  const bool loads = kind == StageJob::Kind::load, other_loads = other.kind == StageJob::Kind::load;
  return std::tuple(urgency, -remaining, loads, stage, arrival) <
         std::tuple(other.urgency, -other.remaining, other_loads, other.stage, other.arrival);
}

void Admission::add(StageJobPtr job) {
  if (job->kind == StageJob::Kind::compute) waiting_computations_++;
  const Rank rank = {urgency_of(job->kind), remaining_[job->stage], job->kind, job->stage, arrivals_++};
  waiting_.emplace(rank, Waiting{std::move(job)});
}

bool Admission::fits(const StageJob& job, uint64_t held) const {
  return (computing_ == 0 && storing_ == 0) || in_use_ + held + job.memory <= memory_;
}

uint64_t Admission::lacking(uint64_t held) const {
  uint64_t wanted = in_use_ + held;
  const auto next = overdue() ? waiting_.find(refusals_.front().rank)
                              : std::find_if(waiting_.begin(), waiting_.end(), [](const auto& waiting) {
                                  return waiting.second.job->kind == StageJob::Kind::compute;
                                });
  if (running_ < threads_ && next != waiting_.end()) wanted += next->second.job->memory;
  return wanted - std::min(wanted, memory_);
}

bool Admission::may_load(uint64_t held) const {
  return in_use_ + held < memory_ || (running_ == 0 && waiting_computations_ == 0);
}

bool Admission::overdue() const {
  return !refusals_.empty() && computations_ - refusals_.front().computations_before >= patience;
}

bool Admission::may_start(const Queue::iterator& at, uint64_t held) {
  Waiting& waiting = at->second;
  if (overdue()) return false;
  if (waiting.job->kind == StageJob::Kind::load) return may_load(held);
  if (fits(*waiting.job, held)) return true;
  if (!std::exchange(waiting.refused, true)) refusals_.push_back({at->first, computations_});
  return false;
}

Admission::Queue::iterator Admission::remove(Queue::iterator at) {
  if (at->second.job->kind == StageJob::Kind::compute) waiting_computations_--;
  if (at->second.refused)
    std::erase_if(refusals_, [&](const Refusal& r) { return r.rank.arrival == at->first.arrival; });
  return waiting_.erase(at);
}

Admission::Queue::iterator Admission::start(Queue::iterator at, std::vector<StageJobPtr>& admitted) {
  const StageJobPtr& job = admitted.emplace_back(at->second.job);
  running_++;
  if (job->kind == StageJob::Kind::store) storing_++;
  if (job->kind == StageJob::Kind::compute) {
    computing_++;
    computations_++;
    in_use_ += job->memory;
  }
  return remove(at);
}

std::vector<StageJobPtr> Admission::admit(uint64_t held) {
  std::vector<StageJobPtr> admitted;
  while (running_ < threads_ && !waiting_.empty() && waiting_.begin()->first.urgency < urgency_of_values)
    start(waiting_.begin(), admitted);
  while (overdue() && running_ < threads_) {
    const auto at = waiting_.find(refusals_.front().rank);
    if (!fits(*at->second.job, held)) break;
    start(at, admitted);
  }
  for (auto at = waiting_.begin(); at != waiting_.end() && running_ < threads_;)
    at = may_start(at, held) ? start(at, admitted) : std::next(at);
  return admitted;
}

void Admission::ended(const StageJob& job) {
  running_--;
  if (job.kind == StageJob::Kind::store) storing_--;
  if (job.kind != StageJob::Kind::compute) return;
  computing_--;
  in_use_ -= job.memory;
}

void Admission::forget_if(const std::function<bool(const StageJob&)>& unwanted) {
  for (auto at = waiting_.begin(); at != waiting_.end();) at = unwanted(*at->second.job) ? remove(at) : std::next(at);
}

}  // namespace terrazzo
