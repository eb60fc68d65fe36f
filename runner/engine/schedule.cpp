#include "runner/engine/schedule.h"

#include <algorithm>
#include <mutex>
#include <thread>

#include <fmt/format.h>
#include <tbb/flow_graph.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/task_arena.h>
#include <unistd.h>

#include "core/base/text.h"
#include "runner/engine/coordinator.h"
#include "runner/engine/history.h"
#include "runner/engine/stale_outputs.h"

namespace terrazzo {

namespace {

uint64_t half_of_memory() {
  return static_cast<uint64_t>(::sysconf(_SC_PHYS_PAGES)) * static_cast<uint64_t>(::sysconf(_SC_PAGE_SIZE)) / 2;
}

/// Small numbers for threads, in the order in which they are first seen.
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

std::string_view span_name(Job::Kind kind) {
  constexpr std::array<std::string_view, 5> names = {"begin", "look up", "load", "run", "store"};
  return names[static_cast<size_t>(kind)];
}

/// The flow graph of every run: jobs go round between many workers and one coordinator until none is left.
void execute(Coordinator& coordinator, const Plan& plan, const RunOptions& options,
             std::chrono::steady_clock::time_point start) {
  namespace flow = tbb::flow;
  ThreadNumbers threads;
  const auto now = [start] { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(); };
  flow::graph graph;
  flow::function_node<JobPtr, JobPtr> work(graph, flow::unlimited, [&](const JobPtr& job) {
    job->span = {std::string(span_name(job->kind)), job->stage, threads.current(), now(), 0};
    perform(*job, plan, options);
    job->span.end = now();
    return job;
  });
  using Coordinate = flow::multifunction_node<JobPtr, std::tuple<JobPtr>>;
  Coordinate coordinate(graph, flow::serial, [&](const JobPtr& job, Coordinate::output_ports_type& ports) {
    coordinator.settle(*job);
    for (JobPtr& next : coordinator.admit()) std::get<0>(ports).try_put(next);
  });
  flow::make_edge(flow::output_port<0>(coordinate), work);
  flow::make_edge(work, coordinate);
  coordinate.try_put(std::make_shared<Job>());
  graph.wait_for_all();
}

/// Only now: as long as nodes run, one may be about to write into a folder that another has made and left empty.
void remove_if_empty(const std::vector<std::filesystem::path>& folders) {
  std::error_code not_empty;
  for (size_t i = folders.size(); i-- > 0;) std::filesystem::remove(folders[i], not_empty);
}

}  // namespace

int RunResult::count(StageOutcome::Kind kind) const {
  return static_cast<int>(
      std::count_if(stages.begin(), stages.end(), [&](const StageOutcome& s) { return s.kind == kind; }));
}

std::string RunResult::summary() const {
  using Kind = StageOutcome::Kind;
  const int reused = count(Kind::reused), run = count(Kind::run), failed = count(Kind::failed),
            unfinished = count(Kind::unfinished), all = reused + run + failed + unfinished;
  std::string out = fmt::format("{}: {} cached, {} run", counted(all, "stage"), reused, run);
  if (failed > 0) out += fmt::format(", {} failed", failed);
  if (unfinished > 0) out += fmt::format(", {} not run", unfinished);
  return out + fmt::format(", {:.2f} s", seconds);
}

RunResult run_plan(Plan plan, const RunOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  const int threads = options.threads > 0 ? options.threads : tbb::info::default_concurrency();
  const uint64_t memory = options.memory > 0 ? options.memory : half_of_memory();
  if (options.observer) options.observer->planned(plan);

  Coordinator coordinator(plan, options, threads, memory);
  const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, static_cast<size_t>(threads));
  tbb::task_arena arena(threads);
  arena.execute([&] { execute(coordinator, plan, options, start); });

  remove_if_empty(coordinator.take_made_folders());
  if (options.history) options.history->save();
  RunResult result;
  result.cancelled = coordinator.cancelled();
  result.failures = coordinator.take_failures();
  result.stages = coordinator.take_outcomes();
  if (result.ok())
    for (auto& [stage, note] : notes_on_stale_outputs(plan, result.stages)) {
      if (options.observer) options.observer->noted(plan.stages[stage], note);
      result.stages[stage].notes.push_back(std::move(note));
    }
  result.kept = coordinator.take_kept();
  result.spans = coordinator.take_spans();
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (result.ok() && result.count(StageOutcome::Kind::unfinished) > 0)
    throw std::logic_error("the scheduler came to rest before its work was done");
  return result;
}

RunResult run_graph(const Graph& graph, const RunOptions& options) {
  return run_plan(make_plan(graph, options.cache, options.targets, options.history), options);
}

}  // namespace terrazzo
