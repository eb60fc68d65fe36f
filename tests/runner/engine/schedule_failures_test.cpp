#include <atomic>
#include <chrono>
#include <filesystem>
#include <thread>

#include <doctest/doctest.h>

#include "runner/engine/schedule.h"
#include "tests/runner/fakes.h"

/// Runs that go wrong: nodes that fail, that are cancelled, or that cannot be believed.
using namespace terrazzo;
using namespace terrazzo::test;

TEST_CASE("a failing node names graph, place, node and port; what finished is kept, what depends on it is not run") {
  TemporaryFolder folder;
  Cache cache(folder.path() / "cache");
  FakeTypes t;
  Graph g = small_graph(t);
  add(g, "broken", t.fail, {}, {"total"});
  add(g, "after", t.sum, {}, {"broken"});
  add(g, "file", t.write, {{"path", (folder.path() / "out.txt").string()}}, {"after"});
  g.file = "dir/graph.json";
  g.nodes[3].place = {7, 5};
  RunOptions options;
  options.cache = &cache;
  const RunResult r = run_graph(g, options);
  CHECK_FALSE(r.ok());
  CHECK_FALSE(r.cancelled);
  REQUIRE(r.failures.size() == 1);
  CHECK(r.failures[0].message ==
        "dir/graph.json:7:5: node \"broken\" (fail), input \"in\": these numbers cannot be added");
  CHECK(outcome(r, "broken") == "failed");
  CHECK(outcome(r, "after") == "unfinished");
  CHECK(outcome(r, "file") == "unfinished");
  CHECK(listing(folder.path()) == std::vector<std::string>{"cache"});

  CHECK(outcome(run_graph(g, options), "total") == "reused");
}

TEST_CASE("another branch that is running when a node fails finishes, and its result is in the cache") {
  TemporaryFolder folder;
  Cache cache(folder.path());
  FakeTypes t;
  std::atomic<bool> running{false}, failed{false};
  struct Watch : RunObserver {
    std::atomic<bool>& failed_;
    explicit Watch(std::atomic<bool>& f) : failed_(f) {}
    void failed(const Stage&, const std::string&) override { failed_ = true; }
  } watch(failed);
  const auto wait_for = [](const std::atomic<bool>& flag) {
    for (int i = 0; i < 20000 && !flag; i++) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  };
  t.during_sum = [&](NodeContext&) {
    running = true;
    wait_for(failed);
  };
  t.fail.compute = [&](NodeContext&) {
    wait_for(running);
    throw Error("broken");
  };
  Graph g;
  add(g, "slow", t.sum, {{"plus", 1.0}});
  add(g, "later", t.tens, {}, {"slow"});
  add(g, "broken", t.fail);
  RunOptions options;
  options.cache = &cache;
  options.threads = 2;
  options.observer = &watch;
  const RunResult r = run_graph(g, options);
  CHECK(outcome(r, "slow") == "run");
  CHECK(outcome(r, "later") == "unfinished");
  CHECK(outcome(r, "broken") == "failed");
  CHECK(state(make_plan(g, &cache), "slow") == "cached");
}

TEST_CASE("a sink that throws leaves no file behind, and no folder that it made") {
  TemporaryFolder folder;
  FakeTypes t;
  Graph g;
  add(g, "a", t.number, {{"value", 1.0}});
  add(g, "file", t.write_fail, {{"path", (folder.path() / "new/deep/out.txt").string()}}, {"a"});
  const RunResult r = run_graph(g, {});
  REQUIRE(r.failures.size() == 1);
  CHECK(r.failures[0].message ==
        "node \"file\" (write_fail): the disk is full at " + (folder.path() / "new/deep/out.txt").string());
  CHECK(listing(folder.path()).empty());
}

TEST_CASE("what is wrong with an input is said once, however many nodes read it") {
  FakeTypes t;
  Graph g;
  add(g, "a", t.number, {{"value", 1.0}});
  add(g, "first", t.fail, {}, {"a"});
  add(g, "second", t.fail, {}, {"a"});
  std::atomic<int> arrived{0};
  t.fail.compute = [&](NodeContext&) {
    for (arrived++; arrived < 2;) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    throw Error("in", "these numbers cannot be added");
  };
  RunOptions options;
  options.threads = 2;
  const RunResult r = run_graph(g, options);
  CHECK(r.count(StageOutcome::Kind::failed) == 2);
  CHECK(r.failures.size() == 1);
}

TEST_CASE("cancelling stops within a second and leaves no file behind, and no folder that it made") {
  TemporaryFolder folder;
  FakeTypes t;
  Graph g;
  add(g, "a", t.number, {{"value", 1.0}});
  add(g, "file", t.endless, {{"path", (folder.path() / "new/out.txt").string()}}, {"a"});
  std::atomic<bool> cancelled{false};
  struct CancelSoon : RunObserver {
    std::atomic<bool>& flag;
    std::atomic<int> calls{0};
    explicit CancelSoon(std::atomic<bool>& f) : flag(f) {}
    void progressed(const Stage&, double) override {
      if (++calls == 5) flag = true;
    }
  } observer(cancelled);
  RunOptions options;
  options.cancelled = &cancelled;
  options.observer = &observer;
  const RunResult r = run_graph(g, options);
  CHECK(r.cancelled);
  CHECK(r.failures.empty());
  CHECK(observer.calls == 5);
  CHECK(outcome(r, "file") == "unfinished");
  CHECK(listing(folder.path()).empty());
}

TEST_CASE("a run that was cancelled before it began does nothing") {
  FakeTypes t;
  const std::atomic<bool> cancelled{true};
  RunOptions options;
  options.cancelled = &cancelled;
  CHECK(run_graph(small_graph(t), options).cancelled);
  CHECK(t.runs("number") == 0);
}

TEST_CASE("a stage that gives another result for the same key is reported, not believed") {
  TemporaryFolder folder;
  Cache cache(folder.path());
  FakeTypes t;
  double drift = 0;
  t.quick.compute = [&](NodeContext& n) { n.output("out", number_image(drift)); };
  Graph g;
  add(g, "a", t.quick, {{"value", 1.0}});
  add(g, "total", t.sum, {}, {"a"});
  REQUIRE(run_graph(g, keeping({"total"}, &cache)).ok());
  drift = 1;
  set(g, "total", "plus", 1.0);
  const RunResult r = run_graph(g, keeping({"total"}, &cache));
  REQUIRE(r.failures.size() == 1);
  CHECK(r.failures[0].message.find("gave a different result than before") != std::string::npos);
}

TEST_CASE("a node that changes a file it reads is refused, and nothing is filed under the wrong key") {
  TemporaryFolder folder;
  Cache cache(folder.path() / "cache");
  FakeTypes t;
  const std::filesystem::path input = folder.path() / "in.txt";
  write_text(input, "1");
  t.file.compute = [&](NodeContext& n) {
    write_text(input, "22");
    n.output("out", number_image(1));
  };
  Graph g;
  add(g, "a", t.file, {{"path", input.string()}});
  RunOptions options;
  options.cache = &cache;
  const RunResult r = run_graph(g, options);
  REQUIRE(r.failures.size() == 1);
  CHECK(r.failures[0].message.find("were changed while it was reading them") != std::string::npos);
}
