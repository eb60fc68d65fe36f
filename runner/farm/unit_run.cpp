#include "runner/farm/unit_run.h"

#include <algorithm>
#include <thread>

#include <fmt/format.h>

#include "core/file/file_io.h"
#include "runner/api/session.h"

namespace terrazzo {

namespace {

namespace fs = std::filesystem;

const Stage* stage_of(const Plan& plan, const std::string& node) {
  const auto at = std::ranges::find_if(plan.stages, [&](const Stage& s) { return s.node->name == node; });
  return at == plan.stages.end() ? nullptr : &*at;
}

/// All nodes that a unit's results depend on. The unit computes missing results of other units itself.
std::set<std::string> nodes_behind(const Graph& graph, const Unit& unit) {
  std::set<std::string> out;
  std::vector<std::string> open = unit.targets;
  while (!open.empty()) {
    const GraphNode* node = graph.find(open.back());
    open.pop_back();
    if (!node || !out.insert(node->name).second) continue;
    for (const auto& [port, wires] : node->inputs)
      for (const Wire& w : wires) open.push_back(w.node);
  }
  return out;
}

/// The same inputs must give the same results everywhere, or a retry would not be one.
void check_nodes(const fs::path& folder, const FarmJob& job, const Unit& unit, const Graph& graph, Cache& cache) {
  const std::set<std::string> behind = nodes_behind(graph, unit);
  for (const GraphNode& n : graph.nodes) {
    if (!behind.contains(n.name)) continue;
    check_inputs(job, n, folder);
    const auto frozen = job.keys.find(n.name);
    if (frozen != job.keys.end() && key_on_farm(n, cache) == frozen->second) continue;
    throw Error(fmt::format(
        "node \"{}\" ({}) has another key here than when {} froze it: this is terrazzo {}; version, plug-ins and what "
        "$OCIO names must be the same on all machines. Or submit again from here",
        n.name, n.type->name, job.program, TERRAZZO_VERSION));
  }
}

/// Throws Error if a unit that this one needs has failed and its results are still missing.
void check_failures(const fs::path& folder, const FarmJob& job, const Unit& unit, const std::set<std::string>& made) {
  for (const std::string& name : unit.needs) {
    const Unit* needed = job.find(name);
    if (!needed || is_done(*needed, made)) continue;
    if (const auto failure = failure_of(folder, name))
      throw Error(fmt::format("skipped, as \"{}\" failed: {}", name, failure->message));
  }
}

bool has_all_it_needs(const FarmJob& job, const Unit& unit, const std::set<std::string>& made) {
  return std::ranges::all_of(unit.needs, [&](const std::string& name) {
    const Unit* needed = job.find(name);
    return !needed || is_done(*needed, made);
  });
}

/// Opens the results and verifies their checksums: a directory listing is not reliable. Throws Error if they cannot be
/// read.
StageRecord verified(const Stage& stage, Cache& cache) {
  if (!stage.known || !stage.known->record) throw Error("its record is not in the cache");
  for (const OutputFile& f : stage.known->record->files)
    if (content_digest(f.path) != f.content)
      throw Error(fmt::format("{} has changed since it was written", f.path.string()));
  if (stage.type().persist == Persist::payload)
    for (const auto& [port, value] : stage.known->record->outputs)
      if (!cache.load_value(value)) throw Error(fmt::format("its output {} cannot be read", port));
  return *stage.known->record;
}

void pause_for(std::chrono::milliseconds time, const std::atomic<bool>* cancelled) {
  constexpr std::chrono::milliseconds step{50};
  for (auto left = time; left.count() > 0; left -= step) {
    if (cancelled && *cancelled) throw Cancelled();
    std::this_thread::sleep_for(std::min(left, step));
  }
}

/// Calls `look` until it returns true or patience ends, with longer and longer pauses; returns what it returned last.
template <typename Look>
bool look_for(std::chrono::milliseconds patience, const std::atomic<bool>* cancelled, const Look& look) {
  std::chrono::milliseconds pause{100}, waited{0};
  for (;;) {
    if (look()) return true;
    if (waited >= patience) return false;
    pause_for(pause, cancelled);
    waited += pause;
    pause *= 2;
  }
}

}  // namespace

Digest key_on_farm(const GraphNode& node, Cache& cache) {
  return key_of(ingredients_of(node, {}, [&](const fs::path& file) { return digest_of_file(&cache, file); }));
}

UnitResult run_unit(const fs::path& folder, const FarmJob& job, const Unit& unit, const UnitRunOptions& options) {
  const LoadedGraph loaded = load_frozen(folder, job.document);
  Session session({.cache = options.cache, .threads = options.threads, .memory = options.memory});
  Cache& cache = *session.cache();
  check_nodes(folder, job, unit, loaded.graph, cache);
  const RunRequest run{.only = unit.targets, .observer = options.observer, .cancelled = options.cancelled};

  RunRequest with_needs{.only = unit.targets, .look_ahead = false};
  with_needs.only.insert(with_needs.only.end(), unit.needs.begin(), unit.needs.end());
  look_for(options.patience, options.cancelled, [&] {
    const Plan plan = session.plan(loaded.graph, with_needs);
    const std::set<std::string> made = made_nodes(plan);
    if (is_done(unit, made)) return true;
    check_failures(folder, job, unit, made);
    return has_all_it_needs(job, unit, made);
  });

  UnitResult result{.run = session.run(loaded.graph, run)};
  if (!result.run.ok()) return result;
  std::string trouble;
  const bool is_there = look_for(options.patience, options.cancelled, [&] {
    try {
      const Plan plan = session.plan(loaded.graph, run);
      for (const std::string& target : unit.targets) result.made[target] = verified(*stage_of(plan, target), cache);
      return true;
    } catch (const Error& e) {
      trouble = e.what();
      return false;
    }
  });
  if (!is_there)
    throw Error(fmt::format("\"{}\" was made, but {}; is the cache {} full, or not the same on all machines?",
                            unit.name, trouble, options.cache.string()));
  return result;
}

}  // namespace terrazzo
