#include "runner/api/session.h"

#include <filesystem>
#include <optional>

#include "runner/engine/schedule.h"
#include "runner/plan/history.h"

namespace terrazzo {

namespace {

/// The history beside the cache; nullopt for a graph without a file.
std::optional<History> history_of(const Graph& graph, const Cache* cache) {
  if (!cache || graph.file.empty()) return std::nullopt;
  return History(cache->folder(), graph.file);
}

/// Documents in memory have no history either: several may share a name.
std::optional<History> history_of(const CheckedJob& job, const Cache* cache) {
  std::error_code missing;
  return std::filesystem::exists(job.graph().file, missing) ? history_of(job.graph(), cache) : std::nullopt;
}

History* pointer_to(std::optional<History>& history) {
  return history ? &*history : nullptr;
}

}  // namespace

Session::Session(SessionOptions options) : options_(std::move(options)) {
  if (options_.use_cache && !options_.checked)
    cache_ = std::make_shared<Cache>(options_.cache.empty() ? Cache::default_folder() : options_.cache);
}

Session::Session(std::shared_ptr<Cache> cache, const SessionOptions& options)
    : options_(options), cache_(std::move(cache)) {}

Session::~Session() = default;

RunOptions Session::options_for(const Graph& graph, const RunRequest& request) const {
  return {.targets = {.only = nodes_meant(graph, request.only),
                      .keep = nodes_meant(graph, request.keep),
                      .look_ahead = request.look_ahead,
                      .keep_going = request.keep_going},
          .cache = cache_.get(),
          .threads = options_.threads,
          .memory = options_.memory,
          .checked = options_.checked,
          .cancelled = request.cancelled,
          .observer = request.observer,
          .sandbox = request.sandbox};
}

Plan Session::plan(const CheckedJob& job, const RunRequest& request) {
  std::optional<History> history = history_of(job, cache_.get());
  return make_plan(job.graph(), cache_.get(), options_for(job.graph(), request).targets, pointer_to(history));
}

Plan Session::plan(const Graph& graph, const RunRequest& request) {
  std::optional<History> history = history_of(graph, cache_.get());
  return make_plan(graph, cache_.get(), options_for(graph, request).targets, pointer_to(history));
}

RunResult Session::run(const CheckedJob& job, const RunRequest& request) {
  std::optional<History> history = history_of(job, cache_.get());
  const PlanOptions targets = options_for(job.graph(), request).targets;
  return run(make_plan(job.graph(), cache_.get(), targets, pointer_to(history)), request, pointer_to(history));
}

RunResult Session::run(const Graph& graph, const RunRequest& request) {
  std::optional<History> history = history_of(graph, cache_.get());
  const PlanOptions targets = options_for(graph, request).targets;
  return run(make_plan(graph, cache_.get(), targets, pointer_to(history)), request, pointer_to(history));
}

RunResult Session::run(Plan plan, const RunRequest& request) {
  std::optional<History> history = history_of(*plan.graph, cache_.get());
  return run(std::move(plan), request, pointer_to(history));
}

RunResult Session::run(Plan plan, const RunRequest& request, History* history) {
  RunOptions options = options_for(*plan.graph, request);
  options.history = history;
  RunResult result = run_plan(std::move(plan), options);
  if (cache_) cache_->collect_if_due();
  return result;
}

std::vector<std::string> Session::take_warnings() {
  return cache_ ? cache_->take_warnings() : std::vector<std::string>();
}

}  // namespace terrazzo
