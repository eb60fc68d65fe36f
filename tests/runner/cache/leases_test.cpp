#include <csignal>
#include <map>
#include <memory>
#include <thread>

#include <doctest/doctest.h>
#include <fmt/format.h>

#include "core/base/processes.h"
#include "runner/cache/cache_folder.h"
#include "runner/cache/cache_leases.h"
#include "runner/cache/lease_folder.h"
#include "tests/runner/fakes.h"
#include "tests/runner/program.h"
#include "tests/runner/workplace.h"

/// Runs that share a cache compute a stage once. Leases of two objects are as much apart within a process as between
/// two, so most of this needs no second one.
using namespace terrazzo;
using namespace terrazzo::test;
namespace fs = std::filesystem;

namespace {

struct Waits : RunObserver {
  std::atomic<int> count{0};
  std::function<void()> then;
  void waits(const Stage&) override {
    count++;
    if (then) then();
  }
};

/// A graph of one stage that is worth keeping, "slow", and a folder for caches.
struct OneStage {
  TemporaryFolder folder;
  FakeTypes t;
  Graph graph;
  Cache cache{folder.path()};
  fs::path leases = CacheFolder(folder.path()).leases();

  OneStage() {
    add(graph, "a", t.quick, {{"value", 2.0}});
    add(graph, "slow", t.sum, {{"plus", 1.0}}, {"a"});
  }
  RunResult run(Cache& with, RunObserver* observer = nullptr, const std::atomic<bool>* cancelled = nullptr) const {
    RunOptions options = keeping({"slow"}, &with);
    options.threads = 1;
    options.observer = observer;
    options.cancelled = cancelled;
    return run_graph(graph, options);
  }
};

/// Told by a run somewhere else.
Digest key_of_slow() {
  OneStage elsewhere;
  struct Planned : RunObserver {
    Digest key;
    void finished(const Stage& s, double) override {
      if (s.node->name == "slow") key = s.known->key;
    }
  } planned;
  REQUIRE(elsewhere.run(elsewhere.cache, &planned).ok());
  return planned.key;
}

}  // namespace

TEST_CASE("of two runs of one graph, the one waits for what the other is computing, and computes nothing") {
  OneStage s;
  Cache theirs(s.folder.path());
  Waits waits;
  std::atomic<bool> computing{false}, other_waits{false};
  waits.then = [&] { other_waits = true; };
  s.t.during_sum = [&](NodeContext&) {
    computing = true;
    while (!other_waits) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  };
  RunResult first;
  std::thread run([&] { first = s.run(theirs); });
  while (!computing) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  const RunResult second = s.run(s.cache, &waits);
  run.join();
  CHECK(first.ok());
  CHECK(outcome(first, "slow") == "run");
  CHECK(second.ok());
  CHECK(outcome(second, "slow") == "reused");
  CHECK(kept_number(second, "slow") == 3);
  CHECK(s.t.runs("sum") == 1);
  CHECK(waits.count == 1);
  CHECK(listing(s.leases).empty());
}

TEST_CASE("equal nodes of one graph are computed once, on any number of threads") {
  for (const int threads : {1, 2, 4}) {
    const TemporaryFolder folder;
    FakeTypes t;
    Graph g;
    add(g, "a", t.quick, {{"value", 2.0}});
    std::vector<std::string> same;
    for (int i = 0; i < 6; i++) {
      same.push_back("same" + std::to_string(i));
      add(g, same.back(), t.sum, {{"plus", 1.0}}, {"a"});
    }
    add(g, "slow", t.sum, {{"plus", 7.0}}, same);
    Cache cache(folder.path());
    RunOptions options = keeping({"slow"}, &cache);
    options.threads = threads;
    const RunResult r = run_graph(g, options);
    REQUIRE(r.ok());
    CHECK(kept_number(r, "slow") == 6 * 3 + 7);
    CHECK(t.runs("sum") == 2);
  }
}

TEST_CASE("when the other one goes without a result, the stage is computed after all") {
  OneStage s;
  Leases theirs(s.leases);
  LeaseAttempt other = theirs.try_lease(key_of_slow());
  REQUIRE(other.lease);
  CHECK(Leases(s.leases).try_lease(key_of_slow()).taken);
  CHECK(theirs.try_lease(key_of_slow()).taken);
  Waits waits;
  waits.then = [&] { other.lease.reset(); };
  const RunResult r = s.run(s.cache, &waits);
  CHECK(r.ok());
  CHECK(waits.count == 1);
  CHECK(outcome(r, "slow") == "run");
}

TEST_CASE("a run with one thread goes on with other stages while it waits for another one") {
  OneStage s;
  Leases theirs(s.leases);
  LeaseAttempt other = theirs.try_lease(key_of_slow());
  REQUIRE(other.lease);
  constexpr int steps = 10;
  for (int i = 0; i < steps; i++)
    add(s.graph, fmt::format("step{}", i), s.t.sum, {{"plus", 10.0 + i}},
        {i == 0 ? "a" : fmt::format("step{}", i - 1)});
  struct GiveUp : RunObserver {
    LeaseAttempt& lease;
    explicit GiveUp(LeaseAttempt& l) : lease(l) {}
    void finished(const Stage& stage, double) override {
      if (stage.node->name == fmt::format("step{}", steps - 1)) lease.lease.reset();
    }
  } observer(other);
  RunOptions options = keeping({"slow", fmt::format("step{}", steps - 1)}, &s.cache);
  options.threads = 1;
  options.observer = &observer;
  const RunResult r = run_graph(s.graph, options);
  REQUIRE(r.ok());
  CHECK(outcome(r, "slow") == "run");
  double start = r.seconds, end = 0;
  int waits = 0;
  for (const Span& span : r.spans)
    if (span.what == "wait") {
      CHECK(span.thread > 0);  // it takes no worker's time
      start = std::min(start, span.start);
      end = std::max(end, span.end);
      waits++;
    }
  CHECK(waits >= 1);
  int steps_meanwhile = 0;
  for (const Span& span : r.spans) steps_meanwhile += span.what == "run" && span.start >= start && span.end <= end;
  CHECK(steps_meanwhile > 0);
}

TEST_CASE("the lease of a process is seen without taking it") {
  const TemporaryFolder folder;
  const Digest key{1, 2};
  Leases mine(folder.path()), theirs(folder.path());
  CHECK_FALSE(mine.is_taken(key));
  CHECK(listing(folder.path()).empty());
  LeaseAttempt one = theirs.try_lease(key);
  CHECK(mine.is_taken(key));
  CHECK_FALSE(mine.is_taken(Digest{2, 1}));
  one.lease.reset();
  CHECK_FALSE(mine.is_taken(key));
  CHECK(listing(folder.path()).empty());
  write_text(folder.path() / key.hex(), "");  // as earlier versions left it
  CHECK_FALSE(mine.is_taken(key));
  CHECK(mine.try_lease(key).lease);
  fs::create_directory(folder.path() / key.hex());  // as a process leaves it that is killed while it gives it up
  CHECK_FALSE(mine.is_taken(key));
  CHECK(mine.try_lease(key).lease);
}

TEST_CASE("a run that waits for another one can be cancelled") {
  OneStage s;
  Leases theirs(s.leases);
  const LeaseAttempt other = theirs.try_lease(key_of_slow());
  Waits waits;
  std::atomic<bool> cancelled{false};
  waits.then = [&] { cancelled = true; };
  const RunResult r = s.run(s.cache, &waits, &cancelled);
  CHECK(r.cancelled);
  CHECK(outcome(r, "slow") == "unfinished");
  CHECK(s.t.runs("sum") == 0);
}

TEST_CASE("the lease of a dead process is free, and what it leaves is cleared away") {
  OneStage s;
  write_text(s.leases / key_of_slow().hex(), "");
  write_text(s.leases / "somebody-else", "");
  Waits waits;
  CHECK(s.run(s.cache, &waits).ok());
  CHECK(waits.count == 0);
  CHECK(s.t.runs("sum") == 1);
  CHECK(listing(s.leases) == std::vector<std::string>{"somebody-else"});
  Leases theirs(s.leases);
  const LeaseAttempt held = theirs.try_lease(Digest{1, 2});
  s.cache.collect();
  CHECK(listing(s.leases) == std::vector<std::string>{Digest{1, 2}.hex()});
}

TEST_CASE("a cache without a place for leases does without them") {
  OneStage s;
  fs::remove(s.leases);
  write_text(s.leases, "");
  CHECK(s.run(s.cache).ok());
  CHECK(s.t.runs("sum") == 1);
}

TEST_CASE("of programs that run one graph at once, one lays it out; killing it makes another one do so") {
  const Workplace w;
  write_picture(w.path / "maps/stone_basecolor.png", 5);
  fs::create_directories(w.path / "second");
  const std::vector<std::string> args = {"synth",      (w.path / "maps").string(),
                                         "-o",         (w.path / "out").string(),
                                         "--size",     "2048x2048",
                                         "--progress", "json",
                                         "--cache",    (w.path / "shared").string()};
  StartedProgram first(w.path, args);
  REQUIRE(first.says("\"start\",\"node\":\"layout\""));
  StartedProgram second(w.path / "second", args);
  REQUIRE(second.says("{\"event\":\"wait\",\"node\":\"layout\"}"));
  first.signal(SIGKILL);
  first.wait();
  const ProgramRun r = second.wait();
  CHECK_MESSAGE(r.code == 0, r.err);
  CHECK(r.err.find("\"start\",\"node\":\"layout\"") != std::string::npos);
  CHECK(listing(w.path / "out") == std::vector<std::string>{"base_color.png"});
}

TEST_CASE("a lease that is not renewed is taken over, and who held it disturbs nobody when it goes on") {
  using std::chrono::milliseconds;
  const TemporaryFolder folder;
  const Digest key{1, 2};
  const LeaseTimes stopped{std::chrono::hours(1), milliseconds(50)}, lively{milliseconds(5), milliseconds(50)};
  Leases theirs(folder.path(), stopped), mine(folder.path(), lively), third(folder.path(), lively);
  LeaseAttempt old = theirs.try_lease(key);
  REQUIRE(old.lease);
  CHECK(mine.try_lease(key).taken);  // seen for the first time
  while (mine.is_taken(key)) std::this_thread::sleep_for(milliseconds(5));
  const LeaseAttempt taken = mine.try_lease(key);
  REQUIRE(taken.lease);
  CHECK(third.try_lease(key).taken);
  old.lease.reset();
  CHECK(third.is_taken(key));
  CHECK(holder_of(folder.path() / key.hex()));
  CHECK(listing(folder.path()) == std::vector<std::string>{key.hex()});
}

TEST_CASE("a lease that is renewed is never taken over, however long its stage takes") {
  using std::chrono::milliseconds;
  const TemporaryFolder folder;
  const Digest key{1, 2};
  Leases theirs(folder.path(), {milliseconds(2), milliseconds(300)});
  Leases mine(folder.path(), {milliseconds(2), milliseconds(300)});
  const LeaseAttempt held = theirs.try_lease(key);
  const auto beat = [&] { return holder_of(folder.path() / key.hex())->beat; };
  CHECK(mine.is_taken(key));
  while (beat() < 300) {  // at least 600 ms
    REQUIRE(mine.is_taken(key));
    std::this_thread::sleep_for(milliseconds(1));
  }
}

TEST_CASE("a lease is taken only from a holder that has not renewed it since it was seen") {
  const TemporaryFolder folder;
  const std::filesystem::path lease = folder.path() / "lease";
  LeaseHolder holder{new_lease_holder()};
  REQUIRE(claim_lease(lease, holder));
  const LeaseHolder seen = holder_of(lease).value();
  REQUIRE(renew_lease(lease, holder));
  take_lease_away(lease, seen);
  CHECK(holder_of(lease) == holder);
  take_lease_away(lease, holder);
  CHECK_FALSE(holder_of(lease));
  CHECK_FALSE(renew_lease(lease, holder));
  CHECK(claim_lease(lease, LeaseHolder{new_lease_holder()}));
}

TEST_CASE("of many that take over at once, one gets the lease") {
  const TemporaryFolder folder;
  const Digest key{1, 2};
  for (int round = 0; round < 20; round++) {
    const LeaseHolder dead{pid_namespace_id() + "-999999999-0"};
    REQUIRE(claim_lease(folder.path() / key.hex(), dead));
    std::atomic<int> got{0}, arrived{0}, tried{0};
    std::vector<std::thread> threads;
    for (int i = 0; i < 6; i++)
      threads.emplace_back([&] {
        Leases leases(folder.path());
        for (arrived++; arrived < 6;) std::this_thread::yield();
        const LeaseAttempt attempt = leases.try_lease(key);
        if (attempt.lease) got++;
        for (tried++; tried < 6;) std::this_thread::yield();
      });
    for (std::thread& t : threads) t.join();
    CHECK(got == 1);
    CHECK(listing(folder.path()).empty());
  }
}

TEST_CASE("a program that is stopped while it lays out holds up another one for no longer than leases hold") {
  const Workplace w;
  write_picture(w.path / "maps/stone_basecolor.png", 5);
  fs::create_directories(w.path / "second");
  const std::vector<std::string> args = {"synth",      (w.path / "maps").string(),
                                         "-o",         (w.path / "out").string(),
                                         "--size",     "1024x1024",
                                         "--progress", "json",
                                         "--cache",    (w.path / "shared").string()};
  StartedProgram first(w.path, args);
  REQUIRE(first.says("\"start\",\"node\":\"layout\""));
  first.signal(SIGSTOP);
  StartedProgram second(w.path / "second", args);
  REQUIRE(second.says("{\"event\":\"wait\",\"node\":\"layout\"}"));
  const ProgramRun r = second.wait();
  CHECK_MESSAGE(r.code == 0, r.err);
  CHECK(r.err.find("\"start\",\"node\":\"layout\"") != std::string::npos);
  first.signal(SIGCONT);
  const ProgramRun woken = first.wait();
  CHECK_MESSAGE(woken.code == 0, woken.err);
  CHECK(listing(w.path / "out") == std::vector<std::string>{"base_color.png"});
  CHECK(listing(w.path / "shared/v1/leases").empty());
  CHECK(w.run({"cache", "verify", "--cache", "shared"}).out == "every entry is sound\n");
}

TEST_CASE("what several programs need at once is made once, if it is small and slow to make") {
  const Workplace w;
  write_picture(w.path / "maps/stone_basecolor.png", 5, Semantic::base_color, {128, 128});
  std::vector<std::unique_ptr<StartedProgram>> programs;
  for (const char* name : {"one", "two", "three", "four"}) {
    fs::create_directories(w.path / name);
    programs.push_back(std::make_unique<StartedProgram>(
        w.path / name, std::vector<std::string>{"synth", (w.path / "maps").string(), "-o", "out", "--size", "128x128",
                                                "--progress", "json", "--cache", (w.path / "shared").string()}));
  }
  std::map<std::string, int> starts;
  for (const auto& p : programs) {
    const ProgramRun r = p->wait();
    REQUIRE_MESSAGE(r.code == 0, r.err);
    for (const char* node : {"lattice", "space", "index", "layout"})
      starts[node] += r.err.find(fmt::format("\"start\",\"node\":\"{}\"", node)) != std::string::npos;
  }
  for (const auto& [node, count] : starts) CHECK_MESSAGE(count == 1, node);
}
