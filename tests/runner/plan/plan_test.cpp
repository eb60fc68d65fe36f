#include "runner/plan/plan.h"

#include <doctest/doctest.h>

#include "runner/plan/history.h"
#include "runner/plan/planning.h"
#include "tests/runner/fakes.h"

using namespace terrazzo;
using namespace terrazzo::test;

namespace {

/// file -> lazy -> space -> layout -> result -> out.txt, and a branch that nothing needs for `result`.
struct Pipeline {
  TemporaryFolder folder;
  FakeTypes types;
  Cache cache{folder.path() / "cache"};
  Graph graph;
  std::filesystem::path input = folder.path() / "in.txt", output = folder.path() / "out.txt";

  Pipeline() {
    write_text(input, "12");
    graph.file = "graph.json";
    add(graph, "exemplar", types.file, {{"path", input.string()}});
    add(graph, "space", types.tens, {}, {"exemplar"});
    add(graph, "layout", types.sum, {{"plus", 1.0}}, {"space"});
    add(graph, "result", types.lazy_sum, {{"plus", 5.0}}, {"layout", "exemplar"});
    add(graph, "files", types.write, {{"path", output.string()}}, {"result"});
    add(graph, "aside", types.sum, {}, {"exemplar"});
  }
  RunResult run() {
    RunOptions options;
    options.cache = &cache;
    return run_graph(graph, options);
  }
  Plan plan(const PlanOptions& options = {}) { return make_plan(graph, &cache, options); }
};

}  // namespace

TEST_CASE("a first plan runs what can be known and leaves open what depends on it") {
  Pipeline p;
  const Plan plan = p.plan();
  CHECK(state(plan, "exemplar") == "run");
  CHECK(reason(plan, "exemplar") == "never run before with these inputs and parameters");
  CHECK(state(plan, "layout") == "depends");
  CHECK(reason(plan, "layout") == "depends on what @space gives");
  CHECK(state(plan, "aside") == "not needed");
  CHECK(plan.summary() == "5 stages: 1 to run, 4 undecided until earlier stages have run");
}

TEST_CASE("without a cache everything needed runs") {
  Pipeline p;
  const Plan plan = make_plan(p.graph, nullptr);
  CHECK(state(plan, "exemplar") == "run");
  CHECK(reason(plan, "exemplar") == "no cache is used");
}

TEST_CASE("the plan after a run has nothing to do") {
  Pipeline p;
  REQUIRE(p.run().ok());
  const Plan plan = p.plan();
  CHECK(state(plan, "exemplar") == "cached");
  CHECK(state(plan, "result") == "derived");
  CHECK(state(plan, "files") == "up to date");
  CHECK(plan.summary() == "5 stages: 3 cached, 1 up to date, 1 derived");
  CHECK(p.run().count(StageOutcome::Kind::run) == 0);
}

TEST_CASE("a changed parameter re-runs what depends on it and nothing before") {
  Pipeline p;
  REQUIRE(p.run().ok());
  set(p.graph, "layout", "plus", 2.0);
  const Plan plan = p.plan();
  CHECK(state(plan, "space") == "cached");
  CHECK(reason(plan, "space") == "");
  CHECK(state(plan, "layout") == "run");
  CHECK(state(plan, "result") == "depends");
  CHECK(reason(plan, "exemplar") == "made again if @result runs: its result is not stored");
  const RunResult r = p.run();
  CHECK(outcome(r, "space") == "reused");
  CHECK(outcome(r, "layout") == "run");
  CHECK(outcome(r, "files") == "run");
  CHECK(read_text(p.output) == "20\n");
}

TEST_CASE("touching a file re-runs nothing, changing it re-runs what reads it") {
  Pipeline p;
  REQUIRE(p.run().ok());
  namespace fs = std::filesystem;
  fs::last_write_time(p.input, fs::last_write_time(p.input) + std::chrono::seconds(5));
  CHECK(p.plan().count(StageState::run) == 0);
  write_text(p.input, "130");
  CHECK(state(p.plan(), "exemplar") == "run");
}

TEST_CASE("an input file may move: only its content is in the key") {
  Pipeline p;
  REQUIRE(p.run().ok());
  const std::filesystem::path elsewhere = p.folder.path() / "elsewhere.txt";
  std::filesystem::rename(p.input, elsewhere);
  set(p.graph, "exemplar", "path", elsewhere.string());
  CHECK(p.plan().count(StageState::run) == 0);
}

TEST_CASE("an output that is gone or was changed is written again, and only that") {
  Pipeline p;
  REQUIRE(p.run().ok());
  write_text(p.output, "something");
  CHECK(reason(p.plan(), "files") == "output file " + p.output.string() + " was changed since");
  std::filesystem::remove(p.output);
  const Plan plan = p.plan();
  CHECK(state(plan, "files") == "run");
  CHECK(reason(plan, "files") == "output file " + p.output.string() + " is missing");
  CHECK(state(plan, "layout") == "cached");
  CHECK(state(plan, "result") == "derived");
  CHECK(reason(plan, "result") == "made when @files asks for it");
  CHECK(state(plan, "exemplar") == "run");
  CHECK(reason(plan, "exemplar") == "@result needs its result, which is not stored");
  const RunResult r = p.run();
  REQUIRE(r.ok());
  CHECK(outcome(r, "layout") == "reused");
  CHECK(outcome(r, "files") == "run");
  CHECK(read_text(p.output) == "19\n");
}

TEST_CASE("only some nodes: what they need runs, the rest does not") {
  Pipeline p;
  const Plan plan = p.plan({.only = {"layout", "aside"}, .keep = {}});
  CHECK(state(plan, "result") == "not needed");
  CHECK(state(plan, "files") == "not needed");
  CHECK(state(plan, "aside") == "depends");
  RunOptions options;
  options.cache = &p.cache;
  options.targets.only = {"layout"};
  REQUIRE(run_graph(p.graph, options).ok());
  CHECK(state(p.plan({.only = {"layout"}, .keep = {}}), "layout") == "cached");
  CHECK_FALSE(std::filesystem::exists(p.output));
}

TEST_CASE("a target that does not exist is an error that names the ones that do") {
  Pipeline p;
  CHECK_THROWS_WITH_AS(p.plan({.only = {"layot"}, .keep = {}}), doctest::Contains("layout"), Error);
}

TEST_CASE("names, places and comments are not in keys; versions, parameters and inputs are") {
  FakeTypes t;
  const auto key = [](const GraphNode& n, Digest input = {}) {
    return key_of(ingredients_of(n, {{"in", {input}}}, [](const auto&) { return Digest(); }));
  };
  const GraphNode node{"a", &t.sum, {{"plus", 1.0}}, {{"in", {{"source", "out"}}}}, {}, {}};
  GraphNode renamed = node;
  renamed.name = "b";
  renamed.place = {4, 4};
  renamed.inputs["in"][0].node = "renamed_source";
  CHECK(key(node) == key(renamed));
  GraphNode other = node;
  other.params["plus"] = 2.0;
  CHECK(key(node) != key(other));
  CHECK(key(node) != key(node, {1, 2}));
  NodeType newer = t.sum;
  newer.version = 2;
  GraphNode upgraded = node;
  upgraded.type = &newer;
  CHECK(key(node) != key(upgraded));
}

TEST_CASE("a folder may move, but renaming a file in it changes the key") {
  FakeTypes t;
  NodeType type = t.file;
  std::vector<std::filesystem::path> files;
  type.files_read = [&](const Params&) { return files; };
  const auto key = [&](const std::string& folder, const std::string& file) {
    files = {folder + "/" + file};
    return key_of(
        ingredients_of({"a", &type, {{"path", folder}}, {}, {}, {}}, {}, [](const auto&) { return Digest(); }));
  };
  CHECK(key("/x/bricks", "normal.png") == key("/y/z/bricks", "normal.png"));
  CHECK(key("/x/bricks", "normal.png") == key("/x/bricks/", "normal.png"));
  CHECK(key("/x/bricks", "normal.png") != key("/x/bricks", "height.png"));
  CHECK(key("/x/bricks", "normal.png") != key("/x/stones", "normal.png"));
}

TEST_CASE("reasons name the first thing that differs from the last run") {
  Pipeline p;
  const auto history = [&] { return History(p.folder.path(), "graph.json"); };
  RunOptions options;
  options.cache = &p.cache;
  {
    History h = history();
    options.history = &h;
    REQUIRE(run_graph(p.graph, options).ok());
  }
  set(p.graph, "layout", "plus", 2.5);
  const History h = history();
  CHECK(reason(make_plan(p.graph, &p.cache, {}, &h), "layout") == "parameter plus changed from 1 to 2.5");
  write_text(p.input, "35");
  CHECK(reason(make_plan(p.graph, &p.cache, {}, &h), "exemplar") == "the content of " + p.input.string() + " changed");
}

TEST_CASE("the plan's table is aligned and says why") {
  Pipeline p;
  p.graph.nodes.resize(2);
  const std::string key = make_plan(p.graph, nullptr).stages[0].known->key.hex().substr(0, 8);
  CHECK(make_plan(p.graph, nullptr).table() ==
        "2 stages: 1 to run, 1 undecided until earlier stages have run\n"
        "  node      type  shape  state    key       why\n"
        "  exemplar  file  -      run      " +
            key +
            "  no cache is used\n"
            "  space     tens  -      depends  -         depends on what @exemplar gives\n");
}

TEST_CASE("a plan says what changed about a lazy stage, and what has never run") {
  const TemporaryFolder folder;
  const FakeTypes types;
  Cache cache(folder.path() / "cache");
  Graph graph;
  add(graph, "a", types.number, {{"value", 2.0}});
  add(graph, "lazy", types.lazy_sum, {{"plus", 1.0}}, {"a"});
  add(graph, "out", types.write, {{"path", (folder.path() / "out.txt").string()}}, {"lazy"});
  History history(folder.path(), "graph.json");
  RunOptions options;
  options.cache = &cache;
  options.history = &history;
  REQUIRE(run_graph(graph, options).ok());
  set(graph, "lazy", "plus", 3.0);
  const Plan changed = make_plan(graph, &cache, {}, &history);
  CHECK(reason(changed, "lazy") == "parameter plus changed from 1 to 3; made when @out asks for it");
  set(graph, "a", "value", 5.0);
  add(graph, "new", types.sum, {{"plus", 1.0}}, {"a"});
  const Plan open = make_plan(graph, &cache, {.only = {"new", "out"}, .keep = {}}, &history);
  CHECK(reason(open, "new") == "never run before; depends on what @a gives");
  CHECK(reason(open, "out") == "depends on what @lazy gives");
}
