#pragma once

#include <algorithm>
#include <fstream>

#include <doctest/doctest.h>
#include <fmt/format.h>

#include "runner/cache/cache_folder.h"
#include "runner/engine/coordinator.h"
#include "tests/runner/fakes.h"

namespace terrazzo::test {

/// A run of a graph in which the test says what came of every job.
class Table {
 public:
  explicit Table(const Graph& graph, RunOptions given = {}, int threads = 8, uint64_t memory = 1000)
      : options_(std::move(given)),
        plan_(make_plan(graph, options_.cache, options_.targets)),
        coordinator_(plan_, options_, threads, memory) {
    go(std::make_shared<StageJob>());
  }

  int place(const std::string& node) const {
    for (size_t i = 0; i < plan_.stages.size(); i++)
      if (plan_.stages[i].node->name == node) return int(i);
    throw std::logic_error("no node " + node);
  }
  /// "named held": of a node.
  std::string at(const std::string& node) const {
    const int stage = place(node);
    return fmt::format("{} {}", name_of(coordinator_.states().name(stage)),
                       name_of(coordinator_.states().value(stage)));
  }
  /// "run a, look up b": what has started and not ended.
  std::string running() const {
    constexpr std::array<const char*, 5> names = {"begin", "look up", "load", "run", "store"};
    std::string out;
    for (const StageJobPtr& j : running_)
      out += fmt::format("{}{} {}", out.empty() ? "" : ", ", names[size_t(j->kind)],
                         plan_.stages[size_t(j->stage)].node->name);
    return out;
  }

  /// Ends jobs as they would end if all goes well.
  void look_up(const std::string& node) {
    const StageJobPtr job = take(StageJob::Kind::look_up, node);
    job->resolution = resolve(plan_, job->stage, options_.cache, nullptr);
    go(job);
  }
  void compute(const std::string& node, double value, Size size = {1, 1}) {
    const StageJobPtr job = take(StageJob::Kind::compute, node);
    const NodeType& type = *plan_.stages[size_t(job->stage)].node->type;
    for (const Port& p : type.outputs) job->values[p.name] = image(value, size);
    job->record.emplace();
    job->record->seconds = 1;
    job->record->outputs = names_of(type, plan_.stages[size_t(job->stage)].known->key, job->values);
    go(job);
  }
  void load(const std::string& node, double value) {
    const StageJobPtr job = take(StageJob::Kind::load, node);
    job->values["out"] = image(value, {1, 1});
    go(job);
  }
  void store(const std::string& node, bool stored = true) {
    const StageJobPtr job = take(StageJob::Kind::store, node);
    job->stored = stored;
    go(job);
  }
  /// And if it does not.
  void load_in_vain(const std::string& node) { go(take(StageJob::Kind::load, node)); }
  void fail(StageJob::Kind kind, const std::string& node) {
    const StageJobPtr job = take(kind, node);
    job->failure = node + " failed";
    go(job);
  }
  void stop(const std::string& node) {
    const StageJobPtr job = take(StageJob::Kind::compute, node);
    job->cancelled = true;
    go(job);
  }
  void find_busy(const std::string& node) {
    const StageJobPtr job = take(StageJob::Kind::compute, node);
    job->busy = job->waited = true;
    go(job);
  }
  void resume() {
    REQUIRE_FALSE(postponed_.empty());
    const StageJobPtr job = postponed_.front();
    postponed_.erase(postponed_.begin());
    job->resumed = true;
    job->span = {"wait", job->stage, 1000, 1, 2};
    go(job);
  }
  /// A job that nobody has asked for.
  void intrude(StageJob::Kind kind, const std::string& node) {
    auto job = std::make_shared<StageJob>();
    job->kind = kind;
    job->stage = place(node);
    job->values["out"] = number_image(1);
    job->record.emplace();
    job->record->outputs["out"] = Digest{1, 2};
    coordinator_.settle(job);
  }

  Coordinator& coordinator() { return coordinator_; }
  Plan& plan() { return plan_; }
  size_t postponed() const { return postponed_.size(); }

 private:
  static ImagePtr image(double value, Size size) {
    return make_image(size, 1, [&](int, int, int) { return float(value); });
  }
  StageJobPtr take(StageJob::Kind kind, const std::string& node) {
    const auto job = std::find_if(running_.begin(), running_.end(),
                                  [&](const StageJobPtr& j) { return j->kind == kind && j->stage == place(node); });
    REQUIRE_MESSAGE(job != running_.end(), node << " is not among: " << running());
    const StageJobPtr taken = *job;
    taken->span = {"work", taken->stage, 0, 1, 2};
    running_.erase(job);
    return taken;
  }
  void go(const StageJobPtr& job) {
    coordinator_.settle(job);
    for (StageJobPtr& j : coordinator_.admit()) running_.push_back(std::move(j));
    for (StageJobPtr& j : coordinator_.take_postponed()) postponed_.push_back(std::move(j));
  }

  RunOptions options_;
  Plan plan_;
  Coordinator coordinator_;
  std::vector<StageJobPtr> running_, postponed_;
};

/// a -> b -> c, all stored as payload but a, of which only the digest is.
inline Graph chain(const FakeTypes& t) {
  Graph g;
  add(g, "a", t.quick, {{"value", 2.0}});
  add(g, "b", t.sum, {{"plus", 1.0}}, {"a"});
  return add(g, "c", t.sum, {{"plus", 1.0}}, {"b"});
}

/// A chain that has run once, with a cache that knows it.
struct Cached {
  TemporaryFolder folder;
  Cache cache{folder.path()};
  FakeTypes t;
  Graph graph = chain(t);

  Cached() { REQUIRE(run_graph(graph, keeping({"c"}, &cache)).ok()); }
};

inline std::string kind_of(Coordinator& coordinator, int stage) {
  constexpr std::array<const char*, 6> names = {"idle", "reused", "run", "failed", "unfinished", "skipped"};
  return names[size_t(coordinator.outcomes().take_stages()[size_t(stage)].kind)];
}

}  // namespace terrazzo::test
