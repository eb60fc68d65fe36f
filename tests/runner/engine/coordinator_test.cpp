#include "runner/engine/coordinator.h"

#include <algorithm>
#include <fstream>

#include <doctest/doctest.h>
#include <fmt/format.h>

#include "runner/cache/cache_folder.h"
#include "tests/runner/fakes.h"

/// The coordinator alone: jobs are made up, nothing is computed, and there are no threads.
using namespace terrazzo;
using namespace terrazzo::test;

namespace {

/// A run of a graph in which the test says what came of every job.
class Table {
 public:
  explicit Table(const Graph& graph, RunOptions given = {}, int threads = 8, uint64_t memory = 1000)
      : options_(std::move(given)),
        plan_(make_plan(graph, options_.cache, options_.targets)),
        coordinator_(plan_, options_, threads, memory) {
    go(std::make_shared<Job>());
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
    for (const JobPtr& j : running_)
      out += fmt::format("{}{} {}", out.empty() ? "" : ", ", names[size_t(j->kind)],
                         plan_.stages[size_t(j->stage)].node->name);
    return out;
  }

  /// Ends jobs as they would end if all goes well.
  void look_up(const std::string& node) {
    const JobPtr job = take(Job::Kind::look_up, node);
    job->resolution = resolve(plan_, job->stage, options_.cache, nullptr);
    go(job);
  }
  void compute(const std::string& node, double value, Size size = {1, 1}) {
    const JobPtr job = take(Job::Kind::compute, node);
    const NodeType& type = *plan_.stages[size_t(job->stage)].node->type;
    for (const Port& p : type.outputs) job->values[p.name] = image(value, size);
    job->record.emplace();
    job->record->seconds = 1;
    job->record->outputs = names_of(type, plan_.stages[size_t(job->stage)].known->key, job->values);
    go(job);
  }
  void load(const std::string& node, double value) {
    const JobPtr job = take(Job::Kind::load, node);
    job->values["out"] = image(value, {1, 1});
    go(job);
  }
  void store(const std::string& node) { go(take(Job::Kind::store, node)); }
  /// And if it does not.
  void load_in_vain(const std::string& node) { go(take(Job::Kind::load, node)); }
  void fail(Job::Kind kind, const std::string& node) {
    const JobPtr job = take(kind, node);
    job->failure = node + " failed";
    go(job);
  }
  void stop(const std::string& node) {
    const JobPtr job = take(Job::Kind::compute, node);
    job->cancelled = true;
    go(job);
  }
  void find_busy(const std::string& node) {
    const JobPtr job = take(Job::Kind::compute, node);
    job->busy = job->waited = true;
    go(job);
  }
  void resume() {
    REQUIRE_FALSE(postponed_.empty());
    const JobPtr job = postponed_.front();
    postponed_.erase(postponed_.begin());
    job->resumed = true;
    job->span = {"wait", job->stage, 1000, 1, 2};
    go(job);
  }
  /// A job that nobody has asked for.
  void intrude(Job::Kind kind, const std::string& node) {
    auto job = std::make_shared<Job>();
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
  JobPtr take(Job::Kind kind, const std::string& node) {
    const auto job = std::find_if(running_.begin(), running_.end(),
                                  [&](const JobPtr& j) { return j->kind == kind && j->stage == place(node); });
    REQUIRE_MESSAGE(job != running_.end(), node << " is not among: " << running());
    const JobPtr taken = *job;
    taken->span = {"work", taken->stage, 0, 1, 2};
    running_.erase(job);
    return taken;
  }
  void go(const JobPtr& job) {
    coordinator_.settle(job);
    for (JobPtr& j : coordinator_.admit()) running_.push_back(std::move(j));
    for (JobPtr& j : coordinator_.take_postponed()) postponed_.push_back(std::move(j));
  }

  RunOptions options_;
  Plan plan_;
  Coordinator coordinator_;
  std::vector<JobPtr> running_, postponed_;
};

/// a -> b -> c, all stored as payload but a, of which only the digest is.
Graph chain(const FakeTypes& t) {
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

std::string kind_of(Coordinator& coordinator, int stage) {
  constexpr std::array<const char*, 5> names = {"idle", "reused", "run", "failed", "unfinished"};
  return names[size_t(coordinator.outcomes().take_stages()[size_t(stage)].kind)];
}

}  // namespace

TEST_CASE("names go forward as stages are computed, and values are let go behind them") {
  FakeTypes t;
  const Graph g = chain(t);
  Table run(g, keeping({"c"}));
  CHECK(run.running() == "run a");
  CHECK(run.at("a") == "nameless computing");
  CHECK(run.at("b") == "unknown open");
  run.compute("a", 2);
  CHECK(run.at("a") == "named held");
  CHECK(run.at("b") == "looking_up open");
  CHECK(run.running() == "look up b");
  run.look_up("b");
  CHECK(run.at("b") == "nameless computing");
  CHECK(run.at("a") == "named held");
  run.compute("b", 3);
  CHECK(run.at("a") == "named resting");
  CHECK(run.at("b") == "named held");
  run.look_up("c");
  run.compute("c", 4);
  CHECK(run.at("b") == "named resting");
  CHECK(run.at("c") == "named held");  // it is kept
  CHECK(run.running().empty());
  CHECK(number_of(run.coordinator().take_kept().at("c").at("out")) == 4);
}

TEST_CASE("a stage waits for its sources' values once it has to run") {
  Cached c;
  set(c.graph, "c", "plus", 5.0);
  Table run(c.graph, keeping({"c"}, &c.cache));
  CHECK(run.at("a") == "named resting");  // b does not need it
  CHECK(run.at("b") == "named loading");
  CHECK(run.at("c") == "nameless awaiting");
  CHECK(run.running() == "load b");
  run.load("b", 3);
  CHECK(run.at("b") == "named held");
  CHECK(run.at("c") == "nameless computing");
  run.compute("c", 8);
  CHECK(run.at("b") == "named resting");
  CHECK(run.at("c") == "named held");
  CHECK(run.running() == "store c");
}

TEST_CASE("what is stored and not asked for rests, and what it is made of") {
  Cached c;
  Table run(c.graph, keeping({"c"}, &c.cache));
  CHECK(run.at("a") == "named resting");
  CHECK(run.at("b") == "named resting");
  CHECK(run.at("c") == "named loading");
  run.load("c", 4);
  CHECK(run.at("c") == "named held");
  CHECK(run.running().empty());
}

TEST_CASE("a stored result that cannot be read is made again, and what it is made of is asked for after all") {
  Cached c;
  Table run(c.graph, keeping({"c"}, &c.cache));
  run.load_in_vain("c");
  CHECK(run.at("c") == "named awaiting");
  CHECK(run.at("b") == "named loading");
  CHECK(run.at("a") == "named resting");
  run.load_in_vain("b");
  CHECK(run.at("b") == "named awaiting");
  CHECK(run.at("a") == "named computing");
  run.compute("a", 2);
  CHECK(run.at("a") == "named held");
  CHECK(run.at("b") == "named computing");
  run.compute("b", 3);
  CHECK(run.at("a") == "named resting");
  CHECK(run.at("b") == "named held");
  CHECK(run.at("c") == "named computing");
  CHECK(run.running() == "store b, run c");
  run.compute("c", 4);
  CHECK(run.at("b") == "named resting");
  CHECK(run.at("c") == "named held");
  const std::vector<StageOutcome> outcomes = run.coordinator().outcomes().take_stages();
  for (const StageOutcome& o : outcomes) CHECK(o.kind == StageOutcome::Kind::run);
}

TEST_CASE("a result that another reader has had before is read, or made, once more for a late one") {
  FakeTypes t;
  TemporaryFolder folder;
  Cache cache(folder.path());
  Graph g;
  add(g, "a", t.number, {{"value", 2.0}});
  add(g, "b", t.sum, {{"plus", 1.0}}, {"a"});
  add(g, "late", t.sum, {{"plus", 2.0}}, {"a"});
  add(g, "first", t.sum, {{"plus", 3.0}}, {"b"});
  add(g, "last", t.sum, {}, {"first", "late"});
  REQUIRE(run_graph(g, keeping({"last"}, &cache)).ok());
  set(g, "b", "plus", 7.0);
  set(g, "last", "plus", 1.0);
  Table run(g, keeping({"last"}, &cache));
  run.load("a", 2);
  run.compute("b", 9);
  CHECK(run.at("a") == "named resting");
  run.look_up("first");
  run.compute("first", 12);
  run.look_up("last");
  CHECK(run.at("last") == "nameless awaiting");
  CHECK(run.at("late") == "named loading");
  run.load_in_vain("late");
  CHECK(run.at("a") == "named loading");  // from resting, a second time
  run.load("a", 2);
  CHECK(run.at("late") == "named computing");
  run.compute("late", 4);
  CHECK(run.at("a") == "named resting");
  CHECK(run.at("last") == "nameless computing");
}

TEST_CASE("a recipe has its name before it is made, and is made only for a reader") {
  Cached c;
  add(c.graph, "lazy", c.t.lazy_sum, {}, {"a"});
  add(c.graph, "new", c.t.sum, {}, {"lazy"});
  Table run(c.graph, keeping({"new", "c"}, &c.cache));
  CHECK(run.at("lazy") == "named awaiting");
  CHECK(run.at("new") == "nameless awaiting");
  CHECK(run.at("a") == "named computing");
  run.compute("a", 2);
  run.compute("lazy", 2);
  CHECK(run.at("a") == "named resting");
  CHECK(run.at("new") == "nameless computing");

  Table only(c.graph, keeping({"c"}, &c.cache));
  CHECK(only.at("lazy") == "unknown open");
}

TEST_CASE("what another process computes is tried again, and nothing else waits for it") {
  Cached c;
  set(c.graph, "b", "plus", 3.0);
  add(c.graph, "aside", c.t.sum, {{"plus", 9.0}}, {"a"});
  Table run(c.graph, keeping({"c", "aside"}, &c.cache), 1);
  run.compute("a", 2);
  REQUIRE(run.running() == "run b");  // the longer way
  run.find_busy("b");
  CHECK(run.at("b") == "nameless computing");
  CHECK(run.postponed() == 1);
  CHECK(run.running() == "run aside");
  run.resume();
  CHECK(run.running() == "run aside");
  CHECK(run.postponed() == 0);
  run.compute("aside", 11);
  run.store("aside");
  CHECK(run.running() == "run b");
  run.find_busy("b");
  CHECK(run.running().empty());
  run.resume();
  CHECK(run.running() == "run b");
  CHECK(run.at("a") == "named held");
  run.compute("b", 5);
  CHECK(run.at("b") == "named held");
  CHECK(run.at("a") == "named resting");
  int waits = 0;
  for (const Span& s : run.coordinator().outcomes().take_spans()) waits += s.what == "wait";
  CHECK(waits == 2);
}

TEST_CASE("a busy stage takes none of the memory that others may use") {
  FakeTypes t;
  t.sum.memory_hint = [](const NodeContext&) { return size_t{800}; };
  Graph g;
  add(g, "first", t.sum);
  add(g, "second", t.sum, {{"plus", 1.0}});
  Table run(g, keeping({"first", "second"}));
  CHECK(run.running() == "run first");
  run.find_busy("first");
  CHECK(run.running() == "run second");
  run.resume();
  CHECK(run.running() == "run second");
}

TEST_CASE("after a failure only what has been computed is stored, and nobody waits for other processes") {
  Cached c;
  set(c.graph, "a", "value", 7.0);
  add(c.graph, "aside", c.t.number, {{"value", 1.0}});
  add(c.graph, "other", c.t.number, {{"value", 2.0}});
  Table run(c.graph, keeping({"c", "aside", "other"}, &c.cache));
  CHECK(run.running() == "run a, run aside, run other");
  run.fail(Job::Kind::compute, "a");
  CHECK(run.coordinator().stopping());
  CHECK(run.at("a") == "nameless computing");
  run.compute("aside", 1);
  CHECK(run.running() == "run other, store aside");
  run.find_busy("other");
  CHECK(run.postponed() == 0);
  run.store("aside");
  CHECK(run.running().empty());
  CHECK_FALSE(run.coordinator().cancelled());
  const std::vector<Failure> failures = run.coordinator().outcomes().take_failures();
  REQUIRE(failures.size() == 1);
  CHECK(failures[0].node == "a");
  CHECK(kind_of(run.coordinator(), run.place("a")) == "failed");
}

TEST_CASE("looking up and loading can fail, too") {
  Cached c;
  set(c.graph, "a", "value", 7.0);
  Table run(c.graph, keeping({"c"}, &c.cache));
  run.compute("a", 7);
  run.fail(Job::Kind::look_up, "b");
  CHECK(run.at("b") == "looking_up open");
  CHECK(run.running() == "store a");

  set(c.graph, "a", "value", 2.0);
  Table again(c.graph, keeping({"c"}, &c.cache));
  again.fail(Job::Kind::load, "c");
  CHECK(again.at("c") == "named loading");
  CHECK(again.running().empty());
}

TEST_CASE("what came after a failure, back from another process, is not tried again") {
  FakeTypes t;
  Graph g;
  add(g, "first", t.number, {{"value", 1.0}});
  add(g, "second", t.number, {{"value", 2.0}});
  Table run(g, keeping({"first", "second"}));
  run.find_busy("first");
  run.fail(Job::Kind::compute, "second");
  run.resume();
  CHECK(run.running().empty());
}

TEST_CASE("nothing starts once the run is cancelled, not even a store") {
  Cached c;
  set(c.graph, "a", "value", 7.0);
  std::atomic<bool> cancelled{false};
  RunOptions options = keeping({"c"}, &c.cache);
  options.cancelled = &cancelled;
  Table run(c.graph, options);
  cancelled = true;
  run.compute("a", 7);
  CHECK(run.coordinator().cancelled());
  CHECK(run.running().empty());
  CHECK(run.at("a") == "named held");

  cancelled = false;
  Table stopped(c.graph, options);
  stopped.stop("a");
  CHECK(stopped.coordinator().cancelled());
  CHECK(stopped.running().empty());
  CHECK(stopped.at("a") == "nameless computing");
}

TEST_CASE("values that wait for their readers count against the budget") {
  FakeTypes t;
  t.sum.memory_hint = [](const NodeContext&) { return size_t{400}; };
  Graph g;
  add(g, "big", t.number, {{"value", 1.0}});
  add(g, "aside", t.number, {{"value", 2.0}});
  add(g, "x", t.sum, {}, {"big"});
  add(g, "y", t.sum, {{"plus", 1.0}}, {"big"});
  add(g, "z", t.sum, {{"plus", 2.0}}, {"aside"});
  for (const int side : {5, 10}) {
    CAPTURE(side);
    Table run(g, keeping({"x", "y", "z"}));
    run.compute("big", 1, {side, side});
    CHECK(run.coordinator().held_memory() == uint64_t(side) * uint64_t(side) * 4);
    run.compute("aside", 2);
    run.look_up("x");
    run.look_up("y");
    run.look_up("z");
    // 1000 bytes are there: beside 104 of values, two of 400 fit; beside 404, one does.
    CHECK(run.running() == (side == 5 ? "run x, run y" : "run x"));
    run.compute("x", 1);
    CHECK(run.running() == (side == 5 ? "run y, run z" : "run y"));
    run.compute("y", 1);
    CHECK(run.coordinator().held_memory() == 12);  // x, y and aside
    CHECK(run.running() == "run z");
    run.compute("z", 1);
    CHECK(run.coordinator().held_memory() == 12);  // all are kept
  }
}

TEST_CASE("what leads to the longest way is computed first") {
  FakeTypes t;
  Graph g;
  add(g, "short", t.number, {{"value", 1.0}});
  add(g, "end", t.sum, {}, {"short"});
  add(g, "long", t.number, {{"value", 2.0}});
  add(g, "middle", t.sum, {}, {"long"});
  add(g, "other_end", t.sum, {}, {"middle"});
  Table run(g, keeping({"end", "other_end"}), 1);
  CHECK(run.running() == "run long");
  run.compute("long", 2);
  run.look_up("middle");
  CHECK(run.running() == "run short");  // as long as the rest of the other way, and before it in the document
  run.compute("short", 1);
  run.look_up("end");
  CHECK(run.running() == "run middle");
}

TEST_CASE("a job that no stage can be waiting for is a fault that names stage, state and event") {
  struct Case {
    Job::Kind kind;
    const char* node;
    const char* message;
  };
  const std::vector<Case> cases = {
      {Job::Kind::load, "a", "stage \"a\" (name nameless, values computing) cannot take the event read"},
      {Job::Kind::compute, "c", "stage \"c\" (name unknown, values open) cannot take the event computed"},
  };
  for (const Case& c : cases) {
    FakeTypes t;
    const Graph g = chain(t);
    Table run(g, keeping({"c"}));
    run.plan().stages[size_t(run.place("c"))].known.emplace();
    CHECK_THROWS_WITH_AS(run.intrude(c.kind, c.node), c.message, std::logic_error);
  }
}
