#include "runner/engine/schedule.h"

#include <condition_variable>
#include <functional>
#include <mutex>
#include <numeric>
#include <thread>

#include <doctest/doctest.h>
#include <fmt/format.h>

#include "core/image/image_limits.h"
#include "tests/runner/fakes.h"

using namespace terrazzo;
using namespace terrazzo::test;

namespace {

/// A sum of a sum that is computed when it is pulled, of the number 2; "total" is 3. Only "total" is stored.
Graph lazy_chain(const FakeTypes& types) {
  Graph g;
  add(g, "a", types.quick, {{"value", 2.0}});
  add(g, "lazy", types.lazy_sum, {{"plus", 1.0}}, {"a"});
  return add(g, "total", types.sum, {}, {"lazy"});
}

}  // namespace

TEST_CASE("a graph runs without a cache and gives the values that were asked for") {
  FakeTypes t;
  const Graph g = small_graph(t);
  const RunResult r = run_graph(g, keeping({"total"}));
  REQUIRE(r.ok());
  CHECK(kept_number(r, "total") == 5);
  CHECK(r.kept.size() == 1);
  CHECK(r.summary().find("3 stages: 0 cached, 3 run, ") == 0);
}

TEST_CASE("results are the same on 1, 2 and 4 threads") {
  FakeTypes t;
  Graph g;
  std::vector<std::string> all = {"n0"};
  std::vector<double> expected = {1};
  add(g, "n0", t.number, {{"value", 1.0}});
  for (int i = 1; i < 60; i++) {
    const size_t from = size_t(i) / 3;
    const std::string name = fmt::format("n{}", i);
    add(g, name, i % 3 ? t.sum : t.lazy_sum, {{"plus", double(i)}}, {all[from]});
    all.push_back(name);
    expected.push_back(expected[from] + i);
  }
  add(g, "total", t.sum, {}, all);
  for (const int threads : {1, 2, 4}) {
    RunOptions options = keeping({"total"});
    options.threads = threads;
    const RunResult r = run_graph(g, options);
    REQUIRE(r.ok());
    CHECK(kept_number(r, "total") == std::accumulate(expected.begin(), expected.end(), 0.0));
  }
}

TEST_CASE("a second run takes everything from the cache and computes nothing") {
  TemporaryFolder folder;
  FakeTypes t;
  const Graph g = small_graph(t);
  {
    Cache cache(folder.path());
    REQUIRE(run_graph(g, keeping({"total"}, &cache)).ok());
  }
  Cache cache(folder.path());
  const RunResult r = run_graph(g, keeping({"total"}, &cache));
  REQUIRE(r.ok());
  CHECK(kept_number(r, "total") == 5);
  CHECK(t.runs("number") == 2);
  CHECK(t.runs("sum") == 1);
  CHECK(outcome(r, "a") == "reused");
  CHECK(outcome(r, "total") == "reused");
}

TEST_CASE("a stage that comes out as before does not re-run its readers") {
  TemporaryFolder folder;
  Cache cache(folder.path() / "cache");
  FakeTypes t;
  Graph g;
  add(g, "source", t.number, {{"value", 41.0}});
  add(g, "rounded", t.tens, {}, {"source"});
  add(g, "after", t.sum, {{"plus", 1.0}}, {"rounded"});
  add(g, "file", t.write, {{"path", (folder.path() / "out.txt").string()}}, {"after"});
  RunOptions options;
  options.cache = &cache;
  REQUIRE(run_graph(g, options).ok());
  CHECK(read_text(folder.path() / "out.txt") == "5\n");

  set(g, "source", "value", 43.0);
  const RunResult same = run_graph(g, options);
  REQUIRE(same.ok());
  CHECK(outcome(same, "source") == "run");
  CHECK(outcome(same, "rounded") == "run");
  CHECK(outcome(same, "after") == "reused");
  CHECK(outcome(same, "file") == "reused");

  set(g, "source", "value", 57.0);
  const RunResult other = run_graph(g, options);
  REQUIRE(other.ok());
  CHECK(outcome(other, "after") == "run");
  CHECK(read_text(folder.path() / "out.txt") == "6\n");
}

TEST_CASE("a stage whose outputs only cached readers want does not run") {
  TemporaryFolder folder;
  Cache cache(folder.path());
  FakeTypes t;
  const Graph g = lazy_chain(t);
  REQUIRE(run_graph(g, keeping({"total"}, &cache)).ok());
  CHECK(t.runs("quick") == 1);
  const RunResult again = run_graph(g, keeping({"total"}, &cache));
  CHECK(kept_number(again, "total") == 3);
  CHECK(t.runs("quick") == 1);
  CHECK(t.runs("lazy_sum") == 1);
  CHECK(t.runs("sum") == 1);
}

TEST_CASE("outputs that are not stored are made again for a reader that runs") {
  TemporaryFolder folder;
  Cache cache(folder.path());
  FakeTypes t;
  Graph g = lazy_chain(t);
  REQUIRE(run_graph(g, keeping({"total"}, &cache)).ok());
  set(g, "total", "plus", 10.0);
  const RunResult r = run_graph(g, keeping({"total"}, &cache));
  CHECK(kept_number(r, "total") == 13);
  CHECK(t.runs("quick") == 2);
  CHECK(t.runs("lazy_sum") == 2);
  CHECK(outcome(r, "a") == "run");
}

TEST_CASE("a value is let go after its last reader, while later nodes still run") {
  FakeTypes t;
  std::weak_ptr<const Image> first;
  int seen = 0;
  t.during_sum = [&](NodeContext& n) {
    const double plus = n.number("plus");
    if (plus == 1) first = n.list<Image>("in").front();
    if (plus == 1 || plus == 3) seen++;
    if (plus == 3) CHECK(first.expired());
  };
  Graph g;
  add(g, "a", t.number, {{"value", 5.0}});
  add(g, "b", t.sum, {{"plus", 1.0}}, {"a"});
  add(g, "c", t.sum, {{"plus", 2.0}}, {"b"});
  add(g, "d", t.sum, {{"plus", 3.0}}, {"c"});
  const RunResult r = run_graph(g, keeping({"d"}));
  REQUIRE(r.ok());
  CHECK(seen == 2);
  CHECK(kept_number(r, "d") == 11);
}

TEST_CASE("independent branches run side by side") {
  FakeTypes t;
  std::mutex mutex;
  std::condition_variable both_here;
  int here = 0;
  bool met = false;
  t.during_sum = [&](NodeContext&) {
    std::unique_lock lock(mutex);
    here++;
    both_here.notify_all();
    if (both_here.wait_for(lock, std::chrono::seconds(20), [&] { return here == 2; })) met = true;
  };
  Graph g;
  add(g, "left", t.sum, {{"plus", 1.0}});
  add(g, "right", t.sum, {{"plus", 2.0}});
  RunOptions options = keeping({"left", "right"});
  options.threads = 2;
  REQUIRE(run_graph(g, options).ok());
  CHECK(met);
}

TEST_CASE("nodes that need more memory than the budget run one after the other, but they run") {
  FakeTypes t;
  std::atomic<int> now{0}, most{0};
  t.during_sum = [&](NodeContext&) {
    most = std::max(most.load(), ++now);
    std::this_thread::sleep_for(std::chrono::milliseconds(3));
    now--;
  };
  t.sum.memory_hint = [](const NodeContext&) { return size_t{1000}; };
  Graph g;
  for (int i = 0; i < 8; i++) add(g, fmt::format("n{}", i), t.sum, {{"plus", double(i)}});
  RunOptions options;
  options.threads = 4;
  options.memory = 500;
  SUBCASE("the run's") {}
  SUBCASE("the process's") {
    set_memory_budget(std::exchange(options.memory, 0));
  }
  const RunResult r = run_graph(g, options);
  set_memory_budget(0);
  REQUIRE(r.ok());
  CHECK(r.count(StageOutcome::Kind::run) == 8);
  CHECK(most == 1);
}

TEST_CASE("notes are repeated from the cache") {
  TemporaryFolder folder;
  Cache cache(folder.path() / "cache");
  FakeTypes t;
  write_text(folder.path() / "in.txt", "1");
  Graph g;
  add(g, "a", t.file, {{"path", (folder.path() / "in.txt").string()}});
  struct Notes : RunObserver {
    std::vector<std::string> all;
    void noted(const Stage& s, const std::string& m) override { all.push_back(s.node->name + ": " + m); }
  };
  for (int run = 0; run < 2; run++) {
    Notes notes;
    RunOptions options;
    options.cache = &cache;
    options.observer = &notes;
    const RunResult r = run_graph(g, options);
    CHECK(outcome(r, "a") == (run == 0 ? "run" : "reused"));
    CHECK(notes.all == std::vector<std::string>{"a: read a number"});
  }
}

TEST_CASE("two thousand nodes are planned and run") {
  FakeTypes t;
  Graph g;
  add(g, "n0", t.number, {{"value", 1.0}});
  for (int i = 1; i < 2000; i++)
    add(g, fmt::format("n{}", i), t.sum, {{"plus", 1.0}}, {fmt::format("n{}", i % 10 ? i - 1 : 0)});
  const RunResult r = run_graph(g, keeping({"n1999"}));
  CHECK(kept_number(r, "n1999") == 11);
  RunOptions all;
  const RunResult whole = run_graph(g, all);
  CHECK(whole.count(StageOutcome::Kind::run) == 2000);
}

namespace {

/// Does `work` on a thread with a stack of 256 KiB.
void with_small_stack(std::function<void()> work) {
  pthread_attr_t attributes;
  REQUIRE(::pthread_attr_init(&attributes) == 0);
  REQUIRE(::pthread_attr_setstacksize(&attributes, 256 << 10) == 0);
  pthread_t thread;
  const auto body = [](void* work) -> void* {
    (*static_cast<std::function<void()>*>(work))();
    return nullptr;
  };
  REQUIRE(::pthread_create(&thread, &attributes, body, &work) == 0);
  REQUIRE(::pthread_join(thread, nullptr) == 0);
  ::pthread_attr_destroy(&attributes);
}

}  // namespace

TEST_CASE("a long chain does not need a deep stack") {
  FakeTypes t;
  Graph g;
  add(g, "n0", t.quick, {{"value", 1.0}});
  for (int i = 1; i < 20000; i++)
    add(g, fmt::format("n{}", i), t.lazy_sum, {{"plus", 1.0}}, {fmt::format("n{}", i - 1)});
  RunOptions options = keeping({"n19999"});
  options.threads = 1;
  RunResult r;
  with_small_stack([&] { r = run_graph(g, options); });
  CHECK(kept_number(r, "n19999") == 20000);
}
