#include "runner/api/session.h"

#include <optional>

#include "runner/engine/history.h"

namespace terrazzo {

namespace {

PlanOptions targets_of(const CheckedJob& job, const RunRequest& request) {
  return {.only = nodes_meant(job.graph(), request.only), .keep = nodes_meant(job.graph(), request.keep)};
}

/// Beside the cache; graphs that were made in memory have none.
std::optional<History> history_of(const CheckedJob& job, const Cache* cache) {
  std::error_code missing;
  const std::filesystem::path& file = job.graph().file;
  if (!cache || file.empty() || !std::filesystem::exists(file, missing)) return std::nullopt;
  return History(cache->folder(), file);
}

}  // namespace

Session::Session(SessionOptions options) : options_(std::move(options)) {
  if (options_.use_cache && !options_.checked)
    cache_ = std::make_unique<Cache>(options_.cache.empty() ? Cache::default_folder() : options_.cache);
}

Session::~Session() {
  if (!cache_ || !has_stored_) return;
  try {
    cache_->collect();
  } catch (const std::exception&) {
    // The next session will.
  }
}

/// It looks at every entry, which takes longer than a run that finds all it needs.
void Session::collect_at_times() {
  {
    const std::lock_guard lock(mutex_);
    has_stored_ = true;
    const auto now = std::chrono::steady_clock::now();
    if (now - collected_ < std::chrono::seconds(10)) return;
    collected_ = now;
    has_stored_ = false;
  }
  cache_->collect();
}

Plan Session::plan(const CheckedJob& job, const RunRequest& request) {
  const std::optional<History> history = history_of(job, cache_.get());
  return make_plan(job.graph(), cache_.get(), targets_of(job, request), history ? &*history : nullptr);
}

RunResult Session::run(const CheckedJob& job, const RunRequest& request) {
  std::optional<History> history = history_of(job, cache_.get());
  RunResult result = run_graph(job.graph(), {.targets = targets_of(job, request),
                                             .cache = cache_.get(),
                                             .history = history ? &*history : nullptr,
                                             .threads = options_.threads,
                                             .memory = options_.memory,
                                             .checked = options_.checked,
                                             .cancelled = request.cancelled,
                                             .observer = request.observer});
  if (cache_ && result.count(StageOutcome::Kind::run) > 0) collect_at_times();
  return result;
}

std::vector<std::string> Session::take_warnings() {
  return cache_ ? cache_->take_warnings() : std::vector<std::string>();
}

}  // namespace terrazzo
