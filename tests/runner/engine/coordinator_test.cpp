#include "tests/runner/engine/coordinator_table.h"

/// The coordinator alone: jobs are made up, nothing is computed, and there are no threads.
using namespace terrazzo;
using namespace terrazzo::test;

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
