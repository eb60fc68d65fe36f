#include "runner/engine/schedule.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <map>
#include <mutex>
#include <thread>

#include <tbb/flow_graph.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/task_arena.h>

#include "core/base/thread_limits.h"
#include "core/image/image_limits.h"
#include "runner/engine/coordinator.h"
#include "runner/engine/lease_waiter.h"
#include "runner/engine/stale_outputs.h"
#include "runner/plan/history.h"

namespace terrazzo {

namespace {

namespace flow = tbb::flow;
using Clock = std::chrono::steady_clock;

/// Numbers threads in the order in which they are first seen.
class ThreadNumbers {
 public:
  int current() {
    const std::lock_guard lock(mutex_);
    return numbers_.try_emplace(std::this_thread::get_id(), static_cast<int>(numbers_.size())).first->second;
  }

 private:
  std::mutex mutex_;
  std::map<std::thread::id, int> numbers_;
};

std::string_view span_name(StageJob::Kind kind) {
  constexpr std::array<std::string_view, 5> names = {"begin", "look up", "load", "run", "store"};
  return names[static_cast<size_t>(kind)];
}

/// Waits get their own rows in timelines, below those of the threads.
constexpr int first_waiting_row = 1000;

/// The flow graph of every run: jobs circulate between many workers and one coordinator until none is left. Jobs whose
/// stage another process is computing wait outside.
class JobGraph {
 public:
  JobGraph(Coordinator& coordinator, const Plan& plan, const RunOptions& options, Clock::time_point start)
      : coordinator_(coordinator), plan_(plan), options_(options), start_(start) {
    flow::make_edge(flow::output_port<0>(coordinate_), work_);
    flow::make_edge(work_, coordinate_);
  }

  void run() {
    coordinate_.try_put(std::make_shared<StageJob>());
    graph_.wait_for_all();
  }

 private:
  using Coordinate = flow::multifunction_node<StageJobPtr, std::tuple<StageJobPtr>>;

  double seconds_at(Clock::time_point t) const { return std::chrono::duration<double>(t - start_).count(); }

  StageJobPtr work(const StageJobPtr& job) {
    job->span = {std::string(span_name(job->kind)), job->stage, threads_.current(), seconds_at(Clock::now()), 0};
    perform(*job, plan_, options_);
    job->span.end = seconds_at(Clock::now());
    return job;
  }

  void coordinate(const StageJobPtr& job, Coordinate::output_ports_type& ports) {
    try {
      const bool stored = job->kind == StageJob::Kind::store;
      coordinator_.settle(job);
      for (StageJobPtr& next : coordinator_.admit()) std::get<0>(ports).try_put(next);
      for (StageJobPtr& busy : coordinator_.take_postponed()) {
        graph_.reserve_wait();
        waiter_.add(std::move(busy));
      }
      if (coordinator_.stopping())
        waiter_.give_all_back();
      else if (stored)
        waiter_.look_now();
    } catch (...) {
      waiter_.give_all_back();  // otherwise the graph would wait for them forever
      throw;
    }
  }

  void take_back(const StageJobPtr& job, const LeaseWaiter::Wait& wait) {
    job->span = {"wait", job->stage, first_waiting_row + wait.row, seconds_at(wait.start), seconds_at(wait.end)};
    job->resumed = true;
    coordinate_.try_put(job);
    graph_.release_wait();
  }

  Coordinator& coordinator_;
  const Plan& plan_;
  const RunOptions& options_;
  const Clock::time_point start_;
  ThreadNumbers threads_;
  flow::graph graph_;
  flow::function_node<StageJobPtr, StageJobPtr> work_{graph_, flow::unlimited,
                                                      [this](const StageJobPtr& job) { return work(job); }};
  Coordinate coordinate_{graph_, flow::serial, [this](const StageJobPtr& job, Coordinate::output_ports_type& ports) {
                           coordinate(job, ports);
                         }};
  LeaseWaiter waiter_{[this](const StageJob& job) { return options_.cache->is_leased(job.key(plan_)); },
                      [this](const StageJobPtr& job, const LeaseWaiter::Wait& wait) { take_back(job, wait); },
                      options_.cancelled};
};

/// Only after all nodes: a running node may be about to write into an empty folder that another has created.
void remove_if_empty(const std::vector<std::filesystem::path>& folders) {
  std::error_code not_empty;
  for (size_t i = folders.size(); i-- > 0;) std::filesystem::remove(folders[i], not_empty);
}

/// Threads beyond the number of cores only search for work and take time from the others: with 1024 threads on two
/// cores, two thirds of all time.
int useful_threads(int asked) {
  constexpr int always = 16, per_core = 4;
  const int cores = tbb::info::default_concurrency();
  return asked > 0 ? std::min(asked, std::max(always, per_core * cores)) : cores;
}

}  // namespace

RunResult run_plan(Plan plan, const RunOptions& options) {
  const Clock::time_point start = Clock::now();
  const int threads = useful_threads(options.checked ? 1 : options.threads);
  const uint64_t memory = options.memory > 0 ? options.memory : memory_budget();
  if (options.observer) options.observer->planned(plan);
  // This thread is one of the workers; two more threads renew leases and wait for them.
  require_threads(threads - 1 + 2);

  Coordinator coordinator(plan, options, threads, memory);
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, static_cast<size_t>(threads));
  tbb::task_arena arena(threads);
  arena.execute([&] { JobGraph(coordinator, plan, options, start).run(); });

  Outcomes& outcomes = coordinator.outcomes();
  remove_if_empty(outcomes.take_made_folders());
  if (options.history) options.history->save();
  RunResult result;
  result.cancelled = coordinator.cancelled();
  result.memory = coordinator.most_memory();
  result.failures = outcomes.take_failures();
  result.stages = outcomes.take_stages();
  if (result.ok())
    for (auto& [stage, note] : notes_on_stale_outputs(plan, result.stages)) {
      if (options.observer) options.observer->noted(plan.stages[stage], note);
      result.stages[stage].notes.push_back(std::move(note));
    }
  result.kept = coordinator.take_kept();
  result.spans = outcomes.take_spans();
  result.seconds = std::chrono::duration<double>(Clock::now() - start).count();
  if (result.ok() && result.count(StageOutcome::Kind::unfinished) > 0)
    throw std::logic_error("the scheduler came to rest before its work was done");
  return result;
}

RunResult run_graph(const Graph& graph, const RunOptions& options) {
  return run_plan(make_plan(graph, options.cache, options.targets, options.history), options);
}

}  // namespace terrazzo
