#include <doctest/doctest.h>
#include <fmt/format.h>

#include "tests/runner/engine/coordinator_table.h"

/// Values that wait for later readers give way to what needs memory, if the cache has them.
using namespace terrazzo;
using namespace terrazzo::test;

namespace {

namespace fs = std::filesystem;

constexpr int side = 32;
constexpr uint64_t plane_bytes = uint64_t(side) * side * sizeof(float);

/// Sums that give images of side x side pixels.
struct Planes : FakeTypes {
  NodeType plane = sum;
  std::function<void(const std::string& key)> during_plane;

  explicit Planes(Persist persist = Persist::payload) {
    plane.name = "plane";
    plane.persist = persist;
    plane.memory_hint = [](const NodeContext&) { return size_t{plane_bytes}; };
    plane.compute = [this](NodeContext& n) {
      if (during_plane) during_plane(n.key().hex());
      const double value = n.number("plus");
      n.output("out", make_image({side, side}, 1, [&](int, int, int) { return float(value); }));
    };
  }
};

/// Six planes, read by "total", which is 1 + 2 + ... + 6.
Graph six_planes(const Planes& t) {
  Graph g;
  std::vector<std::string> all;
  for (int i = 1; i <= 6; i++) {
    all.push_back(fmt::format("p{}", i));
    add(g, all.back(), t.plane, {{"plus", double(i)}});
  }
  return add(g, "total", t.sum, {}, all);
}

RunOptions tight(Cache* cache, int threads) {
  RunOptions options = keeping({"total"}, cache);
  options.threads = threads;
  options.memory = 3 * plane_bytes;
  return options;
}

int loads_in(const RunResult& r) {
  return int(std::count_if(r.spans.begin(), r.spans.end(), [](const Span& s) { return s.what == "load"; }));
}

/// Takes everything out of the cache but its folders, when the sixth plane is computed first.
void lose_entries_once(Planes& t, const fs::path& folder) {
  auto computed = std::make_shared<int>(0);
  t.during_plane = [computed, folder](const std::string&) {
    if (++*computed != 6) return;
    for (const auto& entry : fs::recursive_directory_iterator(folder))
      if (entry.is_regular_file()) fs::remove(entry.path());
  };
}

}  // namespace

TEST_CASE("values that the cache has are dropped for what needs their memory, and loaded again for their reader") {
  Cached c;
  c.t.tens.memory_hint = [](const NodeContext&) { return size_t{700}; };
  Graph g;
  add(g, "early", c.t.number, {{"value", 7.0}});
  add(g, "large", c.t.tens, {{"plus", 1.0}});
  add(g, "late", c.t.sum, {}, {"early", "large"});
  for (const bool stored : {true, false}) {
    CAPTURE(stored);
    Table run(g, keeping({"late"}, &c.cache), 1);
    run.compute("early", 7, {10, 10});
    CHECK(run.running() == "store early");
    CHECK(run.at("early") == "named held");
    run.store("early", stored);
    CHECK(run.running() == "run large");
    CHECK(run.at("early") == (stored ? "named resting" : "named held"));
    CHECK(run.coordinator().held_memory() == (stored ? 0 : 400));
    run.compute("large", 0);
    run.store("large");
    run.look_up("late");
    if (stored) run.load("early", 7);
    CHECK(run.running() == "run late");
    CHECK(run.at("early") == "named held");
    run.compute("late", 7);
    run.store("late");
    CHECK(run.coordinator().most_memory() == (stored ? 700 : 1100));
  }
}

TEST_CASE("values are not dropped while a reader has them or is about to, or while there is room") {
  Cached c;
  c.t.tens.memory_hint = [](const NodeContext&) { return size_t{600}; };
  Graph g;
  add(g, "shared", c.t.number, {{"value", 7.0}});
  add(g, "reader", c.t.tens, {}, {"shared"});
  add(g, "later", c.t.sum, {}, {"shared", "reader"});
  Table run(g, keeping({"later"}, &c.cache));
  run.compute("shared", 7, {10, 10});
  run.store("shared");
  run.look_up("reader");
  CHECK(run.running() == "run reader");
  CHECK(run.at("shared") == "named held");
  run.compute("reader", 0);
  CHECK(run.at("shared") == "named held");
}

TEST_CASE("counted memory stays within the budget where the cache has what is held, with the same result") {
  for (const int threads : {1, 2, 4}) {
    CAPTURE(threads);
    Planes t;
    const TemporaryFolder folder;
    Cache cache(folder.path());
    const Graph g = six_planes(t);
    const RunResult with = run_graph(g, tight(&cache, threads)), without = run_graph(g, tight(nullptr, threads));
    CHECK(kept_number(with, "total") == 21);
    CHECK(kept_number(without, "total") == 21);
    CHECK(with.memory <= 3 * plane_bytes);
    CHECK(without.memory >= 6 * plane_bytes);
    CHECK(loads_in(with) >= 3);
    CHECK(loads_in(without) == 0);
  }
}

TEST_CASE("values of which the cache has but the digest stay") {
  Planes t(Persist::digest);
  const TemporaryFolder folder;
  Cache cache(folder.path());
  const RunResult r = run_graph(six_planes(t), tight(&cache, 2));
  CHECK(kept_number(r, "total") == 21);
  CHECK(r.memory >= 6 * plane_bytes);
  CHECK(loads_in(r) == 0);
}

TEST_CASE("where there is room for all, nothing is dropped") {
  Planes t;
  const TemporaryFolder folder;
  Cache cache(folder.path());
  RunOptions options = tight(&cache, 2);
  options.memory = 12 * plane_bytes;
  const RunResult r = run_graph(six_planes(t), options);
  CHECK(kept_number(r, "total") == 21);
  CHECK(loads_in(r) == 0);
}

TEST_CASE("a dropped value that has vanished from the cache is computed again") {
  for (const bool keep_going : {false, true}) {
    Planes t;
    const TemporaryFolder folder;
    Cache cache(folder.path());
    lose_entries_once(t, folder.path());
    RunOptions options = tight(&cache, 1);
    options.targets.keep_going = keep_going;
    const RunResult r = run_graph(six_planes(t), options);
    REQUIRE(r.ok());
    CHECK(kept_number(r, "total") == 21);
    CHECK(std::count_if(r.spans.begin(), r.spans.end(), [](const Span& s) { return s.what == "run"; }) > 7);
  }
}

TEST_CASE("a dropped value that can be neither loaded nor computed again is an error with the node's name") {
  for (const bool keep_going : {false, true}) {
    Planes t;
    const TemporaryFolder folder;
    Cache cache(folder.path());
    lose_entries_once(t, folder.path());
    std::set<std::string> before;
    t.during_plane = [&before, lose = t.during_plane](const std::string& key) {
      lose(key);
      if (!before.insert(key).second) throw Error("not a second time");
    };
    RunOptions options = tight(&cache, 1);
    options.targets.keep_going = keep_going;
    const RunResult r = run_graph(six_planes(t), options);
    REQUIRE(r.failures.size() >= 1);
    CHECK(r.failures.front().message.find("not a second time") != std::string::npos);
    CHECK(outcome(r, r.failures.front().node) == "failed");
    CHECK(outcome(r, "total") == (keep_going ? "skipped" : "unfinished"));
  }
}

TEST_CASE("a run that is cancelled while values are dropped comes to its end") {
  Planes t;
  const TemporaryFolder folder;
  Cache cache(folder.path());
  std::atomic<bool> cancelled{false};
  int computed = 0;
  t.during_plane = [&](const std::string&) { cancelled = ++computed == 5; };
  RunOptions options = tight(&cache, 1);
  options.cancelled = &cancelled;
  CHECK(run_graph(six_planes(t), options).cancelled);
  cancelled = false;
  t.during_plane = nullptr;
  CHECK(kept_number(run_graph(six_planes(t), options), "total") == 21);
}
