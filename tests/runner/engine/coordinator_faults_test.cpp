#include "tests/runner/engine/coordinator_table.h"

/// What goes wrong in a run, to the coordinator alone: jobs are made up, nothing is computed, and there are no threads.
using namespace terrazzo;
using namespace terrazzo::test;

TEST_CASE("after a failure only what has been computed is stored, and nobody waits for other processes") {
  Cached c;
  set(c.graph, "a", "value", 7.0);
  add(c.graph, "aside", c.t.number, {{"value", 1.0}});
  add(c.graph, "other", c.t.number, {{"value", 2.0}});
  Table run(c.graph, keeping({"c", "aside", "other"}, &c.cache));
  CHECK(run.running() == "run a, run aside, run other");
  run.fail(StageJob::Kind::compute, "a");
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
  run.fail(StageJob::Kind::look_up, "b");
  CHECK(run.at("b") == "looking_up open");
  CHECK(run.running() == "store a");

  set(c.graph, "a", "value", 2.0);
  Table again(c.graph, keeping({"c"}, &c.cache));
  again.fail(StageJob::Kind::load, "c");
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
  run.fail(StageJob::Kind::compute, "second");
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

TEST_CASE("a job that no stage can be waiting for is a fault that names stage, state and event") {
  struct Case {
    StageJob::Kind kind;
    const char* node;
    const char* message;
  };
  const std::vector<Case> cases = {
      {StageJob::Kind::load, "a", "stage \"a\" (name nameless, values computing) cannot take the event read"},
      {StageJob::Kind::compute, "c", "stage \"c\" (name unknown, values open) cannot take the event computed"},
  };
  for (const Case& c : cases) {
    FakeTypes t;
    const Graph g = chain(t);
    Table run(g, keeping({"c"}));
    run.plan().stages[size_t(run.place("c"))].known.emplace();
    CHECK_THROWS_WITH_AS(run.intrude(c.kind, c.node), c.message, std::logic_error);
  }
}
