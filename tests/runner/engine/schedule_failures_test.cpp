#include <algorithm>
#include <atomic>
#include <chrono>
#include <filesystem>
#include <set>
#include <thread>

#include <doctest/doctest.h>

#include "runner/engine/schedule.h"
#include "tests/runner/engine/dice.h"
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

TEST_CASE("a set that is torn in the moment of renaming has no description, and the next run makes it whole") {
  TemporaryFolder folder;
  Cache cache(folder.path() / "cache");
  FakeTypes t;
  NodeType set_of_files = t.write;
  const std::filesystem::path out = folder.path() / "out", second = out / "b.txt";
  bool tears = false;
  set_of_files.compute = [&](NodeContext& n) {
    const auto number = int(number_of(n.list<Image>("in").at(0)));
    for (const char* name : {"set.json", "a.txt", "b.txt"})  // the description is named first
      write_text(n.stage(out / name), std::to_string(number));
    if (!tears) return;
    std::filesystem::remove(second);
    std::filesystem::create_directories(second / "in the way");
  };
  Graph g;
  add(g, "number", t.number, {{"value", 1.0}});
  add(g, "files", set_of_files, {{"path", out.string()}}, {"number"});
  const auto contents = [&] {
    std::string all;
    for (const char* name : {"a.txt", "b.txt", "set.json"})
      all += std::filesystem::is_regular_file(out / name) ? read_text(out / name) : "-";
    return all;
  };
  RunOptions options;
  options.cache = &cache;
  REQUIRE(run_graph(g, options).ok());
  CHECK(contents() == "111");
  set(g, "number", "value", 2.0);
  tears = true;
  CHECK_FALSE(run_graph(g, options).ok());
  CHECK(contents() == "2--");
  std::filesystem::remove_all(second);
  tears = false;
  REQUIRE(run_graph(g, options).ok());
  CHECK(contents() == "222");
  CHECK(listing(out) == std::vector<std::string>{"a.txt", "b.txt", "set.json"});
  // As a run that is killed leaves it: the record in the cache is of another set.
  set(g, "number", "value", 1.0);
  write_text(out / "a.txt", "1");
  REQUIRE(run_graph(g, options).ok());
  CHECK(contents() == "111");
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

namespace {

/// Two branches, "left" and "right", that both read "a"; the left one breaks.
Graph two_branches(const FakeTypes& t, const std::filesystem::path& folder) {
  Graph g;
  add(g, "a", t.number, {{"value", 1.0}});
  add(g, "left", t.fail, {}, {"a"});
  add(g, "left2", t.sum, {}, {"left"});
  add(g, "left_file", t.write, {{"path", (folder / "left.txt").string()}}, {"left2"});
  add(g, "right", t.sum, {{"plus", 1.0}}, {"a"});
  add(g, "right_file", t.write, {{"path", (folder / "right.txt").string()}}, {"right"});
  add(g, "both_file", t.write, {{"path", (folder / "both.txt").string()}}, {"right", "left2"});
  return g;
}

struct Skips : RunObserver {
  std::atomic<int> skips{0};
  void skipped(const Stage&, const std::string&) override { skips++; }
};

}  // namespace

TEST_CASE("a run that keeps going makes what does not need a failed node, and says what is skipped because of it") {
  for (const int threads : {1, 4}) {
    TemporaryFolder folder;
    Cache cache(folder.path() / "cache");
    FakeTypes t;
    const Graph g = two_branches(t, folder.path());
    RunOptions options;
    options.threads = threads;
    options.cache = &cache;
    options.targets.keep_going = true;
    Skips observer;
    options.observer = &observer;
    for (const char* right : {"run", "reused"}) {
      const RunResult r = run_graph(g, options);
      CHECK_FALSE(r.ok());
      REQUIRE(r.failures.size() == 1);
      CHECK(outcome(r, "left") == "failed");
      CHECK(outcome(r, "right_file") == right);
      for (const char* skipped : {"left2", "left_file", "both_file"}) CHECK(outcome(r, skipped) == "skipped");
      CHECK(r.count(StageOutcome::Kind::unfinished) == 0);
      CHECK(r.summary().find(", 1 failed, 3 skipped because of that, ") != std::string::npos);
      CHECK(r.skips() == std::vector<std::string>{"skipped, as \"left\" failed: left2, left_file, both_file"});
    }
    CHECK(observer.skips == 6);
    CHECK(listing(folder.path()) == std::vector<std::string>{"cache", "right.txt"});
  }
}

TEST_CASE("what does not need a failed node again is taken from the cache") {
  TemporaryFolder folder;
  Cache cache(folder.path());
  FakeTypes t;
  Graph g;
  add(g, "a", t.quick, {{"value", 1.0}});
  add(g, "kept", t.sum, {{"plus", 1.0}}, {"a"});
  REQUIRE(run_graph(g, keeping({"kept"}, &cache)).ok());
  t.quick.compute = [](NodeContext&) { throw Error("broken"); };
  add(g, "new", t.sum, {{"plus", 2.0}}, {"a", "kept"});
  RunOptions options = keeping({"kept", "new"}, &cache);
  options.targets.keep_going = true;
  const RunResult r = run_graph(g, options);
  CHECK(outcome(r, "kept") == "reused");
  CHECK(kept_number(r, "kept") == 2);
  CHECK(outcome(r, "a") == "failed");
  CHECK(outcome(r, "new") == "skipped");
}

TEST_CASE("runs that keep going come to an end, whatever fails") {
  FakeTypes t;
  for (uint64_t seed = 1; seed <= 40; seed++) {
    TemporaryFolder folder;
    Cache cache(folder.path());
    Dice dice(seed);
    const NodeType* types[] = {&t.sum, &t.quick_sum, &t.lazy_sum, &t.fail};
    Graph g;
    std::set<std::string> ill;
    for (int i = 0; i < 25; i++) {
      const std::string name = "n" + std::to_string(i);
      const NodeType& type = *types[dice.roll(10) == 0 ? 3 : dice.roll(3)];
      std::vector<std::string> in;
      for (int k = i == 0 ? 0 : dice.roll(3); k > 0; k--) in.push_back("n" + std::to_string(dice.roll(i)));
      if (&type == &t.fail || std::any_of(in.begin(), in.end(), [&](const auto& n) { return ill.count(n) == 1; }))
        ill.insert(name);
      add(g, name, type, {{"plus", double(i)}}, in);
    }
    RunOptions options;
    options.cache = &cache;
    options.targets.keep_going = true;
    for (const GraphNode& n : g.nodes) options.targets.keep.push_back(n.name);
    for (int round = 0; round < 2; round++) {
      const RunResult r = run_graph(g, options);
      CHECK(r.count(StageOutcome::Kind::unfinished) == 0);
      for (const StageOutcome& s : r.stages) {
        const bool lost = s.kind == StageOutcome::Kind::failed || s.kind == StageOutcome::Kind::skipped;
        CHECK_MESSAGE(lost == (ill.count(s.node) == 1), "seed " << seed << " " << s.node);
      }
    }
  }
}
