#include "runner/engine/admission.h"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include "runner/plan/history.h"
#include "tests/runner/fakes.h"

using namespace terrazzo;
using namespace terrazzo::test;

namespace {

constexpr uint64_t plenty = 1000;

StageJobPtr job(StageJob::Kind kind, int stage, uint64_t memory = 0) {
  auto j = std::make_shared<StageJob>();
  j->kind = kind;
  j->stage = stage;
  j->memory = memory;
  return j;
}
StageJobPtr compute(int stage, uint64_t memory = 0) {
  return job(StageJob::Kind::compute, stage, memory);
}

/// "run 3, load 1": what was admitted, in that order.
std::string shown(const std::vector<StageJobPtr>& jobs) {
  constexpr std::array<const char*, 5> names = {"begin", "look up", "load", "run", "store"};
  std::string out;
  for (const StageJobPtr& j : jobs)
    out += fmt::format("{}{} {}", out.empty() ? "" : ", ", names[static_cast<size_t>(j->kind)], j->stage);
  return out;
}

void end(Admission& admission, const std::vector<StageJobPtr>& jobs) {
  for (const StageJobPtr& j : jobs) admission.ended(*j);
}

}  // namespace

TEST_CASE("stores come first, then look-ups, then what has the longest path before it, in the document's order") {
  Admission a({5, 9, 9, 2, 9}, 10, plenty);
  for (const int stage : {3, 4, 0, 2, 1}) a.add(compute(stage));
  a.add(job(StageJob::Kind::load, 1));
  a.add(job(StageJob::Kind::load, 0));
  a.add(job(StageJob::Kind::look_up, 3));
  a.add(job(StageJob::Kind::look_up, 1));
  a.add(job(StageJob::Kind::store, 3));
  CHECK(shown(a.admit(0)) == "store 3, look up 1, look up 3, run 1, run 2, run 4, load 1, run 0, load 0, run 3");
  CHECK(shown(a.admit(0)).empty());
}

TEST_CASE("no more jobs run than there are threads") {
  Admission a({1, 1, 1, 1}, 2, plenty);
  for (int i = 0; i < 4; i++) a.add(compute(i));
  std::vector<StageJobPtr> running = a.admit(0);
  CHECK(shown(running) == "run 0, run 1");
  CHECK(a.admit(0).empty());
  a.ended(*running[1]);
  CHECK(shown(a.admit(0)) == "run 2");
  CHECK_FALSE(a.idle());
}

TEST_CASE("computations keep within the budget together with the values in memory, but one may always run") {
  struct Case {
    uint64_t held;
    std::vector<uint64_t> wanted;
    const char* admitted;
  };
  const std::vector<Case> cases = {
      {0, {600, 400}, "run 0, run 1"},   {0, {600, 401}, "run 0"},
      {1, {600, 400}, "run 0"},          {400, {600, 1}, "run 0"},
      {400, {500, 100}, "run 0, run 1"}, {5000, {1, 0}, "run 0"},
      {0, {5000, 0}, "run 0"},           {0, {600, 500, 400}, "run 0, run 2"},
  };
  for (const Case& c : cases) {
    Admission a({1, 1, 1}, 8, plenty);
    for (size_t i = 0; i < c.wanted.size(); i++) a.add(compute(int(i), c.wanted[i]));
    std::vector<StageJobPtr> running = a.admit(c.held);
    CHECK(shown(running) == c.admitted);
    while (!running.empty()) {
      end(a, running);
      running = a.admit(c.held);
    }
    CHECK(a.idle());
  }
}

TEST_CASE("what does not fit waits for what is being stored, which might free memory") {
  Admission a({1, 1, 1}, 8, plenty);
  a.add(job(StageJob::Kind::store, 2));
  const std::vector<StageJobPtr> store = a.admit(500);
  a.add(compute(0, 600));
  CHECK(a.admit(500).empty());
  end(a, store);
  CHECK(shown(a.admit(500)) == "run 0");
}

TEST_CASE("what lacks is what running jobs, values and the next computation take beyond the budget") {
  Admission a({2, 1}, 2, plenty);
  CHECK(a.lacking(plenty) == 0);
  CHECK(a.lacking(plenty + 7) == 7);
  a.add(compute(1, 500));
  a.add(compute(0, 300));
  CHECK(a.lacking(700) == 0);
  CHECK(a.lacking(701) == 1);
  const std::vector<StageJobPtr> first = a.admit(650);
  CHECK(shown(first) == "run 0");
  CHECK(a.in_use() == 300);
  CHECK(a.lacking(300) == 100);
  a.add(job(StageJob::Kind::look_up, 0));
  CHECK(shown(a.admit(650)) == "look up 0");
  CHECK(a.lacking(300) == 0);  // no thread is free for the next
  CHECK(a.lacking(701) == 1);
}

TEST_CASE("a computation that has waited long enough is the next") {
  Admission a(std::vector<double>(20, 1), 4, plenty);
  a.add(compute(19, 900));
  a.add(compute(0, 500));
  const StageJobPtr long_one = a.admit(0).front();
  for (int i = 1; i <= 8; i++) {
    a.add(compute(i));
    end(a, a.admit(0));
  }
  a.add(compute(10));
  CHECK(a.lacking(0) == 400);
}

TEST_CASE("stores and look-ups wait for no memory") {
  Admission a({1, 1, 1}, 8, plenty);
  a.add(compute(0, 5000));
  const std::vector<StageJobPtr> running = a.admit(5000);
  REQUIRE(running.size() == 1);
  a.add(job(StageJob::Kind::store, 1));
  a.add(job(StageJob::Kind::look_up, 2));
  CHECK(shown(a.admit(5000)) == "store 1, look up 2");
}

namespace {

/// Ends the running jobs one by one, the oldest first; small jobs (each of `small` bytes) come as fast as they start.
/// Returns the order in which jobs started.
std::vector<int> run_with_small_ones(Admission& admission, std::vector<StageJobPtr> running, int first, int last,
                                     uint64_t small) {
  std::vector<int> order;
  for (const StageJobPtr& j : running) order.push_back(j->stage);
  int next = first;
  bool small_one_waits = false;
  for (;;) {
    if (!small_one_waits && next <= last) {
      admission.add(compute(next++, small));
      small_one_waits = true;
    }
    for (const StageJobPtr& j : admission.admit(0)) {
      running.push_back(j);
      order.push_back(j->stage);
      if (j->stage == next - 1) small_one_waits = false;
    }
    if (running.empty()) return order;
    admission.ended(*running.front());
    running.erase(running.begin());
  }
}

}  // namespace

TEST_CASE("small jobs pass a large one eight times and not once more, though they come first in the order") {
  static_assert(Admission::patience == 8);
  for (const double rank_of_large : {0.0, 100.0}) {
    CAPTURE(rank_of_large);
    std::vector<double> remaining(31, 1);
    remaining[30] = rank_of_large;
    Admission a(remaining, 3, plenty);
    a.add(compute(0, 500));
    const std::vector<StageJobPtr> running = a.admit(0);
    a.add(compute(30, 700));
    const std::vector<int> order = run_with_small_ones(a, running, 1, 20, 400);
    REQUIRE(order.size() == 22);
    // It is looked at before the first small one starts, or just after.
    CHECK(std::find(order.begin(), order.end(), 30) - order.begin() == (rank_of_large > 1 ? 9 : 10));
    CHECK(a.idle());
  }
}

TEST_CASE("of several large jobs that have been passed over, the one that has waited longest comes first") {
  Admission a(std::vector<double>(40, 1), 3, plenty);
  a.add(compute(0, 300));
  const std::vector<StageJobPtr> running = a.admit(0);
  a.add(compute(30, 900));
  CHECK(a.admit(0).empty());
  a.add(compute(20, 900));  // stands before it in the document
  CHECK(a.admit(0).empty());
  CHECK(run_with_small_ones(a, running, 1, 11, 300) == std::vector<int>{0, 1, 2, 3, 4, 5, 6, 7, 8, 30, 20, 9, 10, 11});
}

TEST_CASE("a large job that has got its turn is not waited for any more") {
  Admission a(std::vector<double>(40, 1), 3, plenty);
  a.add(compute(0, 300));
  std::vector<StageJobPtr> running = a.admit(0);
  a.add(compute(30, 900));
  CHECK(a.admit(0).empty());
  end(a, running);
  running = a.admit(0);
  CHECK(shown(running) == "run 30");
  const std::vector<int> order = run_with_small_ones(a, running, 1, 20, 50);
  std::vector<int> expected = {30};
  for (int i = 1; i <= 20; i++) expected.push_back(i);
  CHECK(order == expected);
}

TEST_CASE("nothing is loaded while the budget is used up, unless there is nothing else to do") {
  Admission a({1, 2, 1}, 4, plenty);
  a.add(job(StageJob::Kind::load, 1));
  a.add(compute(0, 10));
  const std::vector<StageJobPtr> first = a.admit(plenty);
  CHECK(shown(first) == "run 0");
  CHECK(a.admit(plenty).empty());
  a.add(job(StageJob::Kind::load, 2));
  end(a, first);
  CHECK(shown(a.admit(plenty)) == "load 1");
  CHECK(shown(a.admit(plenty - 1)) == "load 2");
}

TEST_CASE("a load does not pass a large job that has been passed over often enough") {
  Admission a(std::vector<double>(20, 1), 4, plenty);
  a.add(compute(0, 500));
  const StageJobPtr long_one = a.admit(0).front();
  a.add(compute(15, 700));
  CHECK(a.admit(0).empty());
  for (int i = 1; i <= 8; i++) {
    a.add(compute(i));
    const std::vector<StageJobPtr> small = a.admit(0);
    REQUIRE(shown(small) == fmt::format("run {}", i));
    end(a, small);
  }
  a.add(job(StageJob::Kind::load, 9));
  a.add(job(StageJob::Kind::look_up, 10));
  CHECK(shown(a.admit(0)) == "look up 10");
  a.ended(*long_one);
  CHECK(shown(a.admit(0)) == "run 15, load 9");
}

TEST_CASE("jobs that are forgotten do not come, and hold nobody up") {
  Admission a(std::vector<double>(20, 1), 2, plenty);
  a.add(compute(0, 500));
  const std::vector<StageJobPtr> running = a.admit(0);
  a.add(compute(15, 700));
  CHECK(a.admit(0).empty());
  for (int i = 1; i <= 8; i++) {
    a.add(compute(i));
    end(a, a.admit(0));
  }
  a.add(compute(9));
  a.add(job(StageJob::Kind::store, 0));
  CHECK(shown(a.admit(0)) == "store 0");
  a.ended(*job(StageJob::Kind::store, 0));
  CHECK(a.admit(0).empty());
  a.forget_if([](const StageJob& j) { return j.stage == 15; });
  CHECK(shown(a.admit(0)) == "run 9");
}

TEST_CASE("the longest path goes by what stages took before, and counts neither what is there nor recipes") {
  TemporaryFolder folder;
  Cache cache(folder.path());
  FakeTypes t;
  Graph g;
  add(g, "there", t.number, {{"value", 1.0}});
  add(g, "file", t.quick, {{"value", 2.0}});      // its record says 3 seconds; its values are not kept
  add(g, "known", t.sum, {}, {"there", "file"});  // the history says 5 seconds
  add(g, "recipe", t.lazy_sum, {}, {"known"});
  add(g, "new", t.sum, {}, {"recipe", "file"});
  add(g, "short", t.tens, {}, {"file"});
  add(g, "aside", t.number, {{"value", 4.0}});
  RunOptions first = keeping({"there", "file"}, &cache);
  REQUIRE(run_graph(g, first).ok());
  const auto key_of_stage = [&](const std::string& node) {
    const Plan plan = make_plan(g, &cache);
    for (const Stage& s : plan.stages)
      if (s.node->name == node) return s.known->key;
    throw std::logic_error(node);
  };
  const Digest key = key_of_stage("file");
  StageRecord record = *cache.find_stage(key);
  record.seconds = 3;
  cache.store_stage(key, record);
  {
    History history(folder.path(), "graph.json");
    history.remember("known", {}, 5);
    history.save();
  }
  const History history(folder.path(), "graph.json");
  const PlanOptions options{.only = {"new", "short"}, .keep = {}};
  CHECK(remaining_seconds(make_plan(g, &cache, options, &history)) == std::vector<double>{6, 9, 6, 1, 1, 1, 0});
  CHECK(remaining_seconds(make_plan(g, &cache, options)) == std::vector<double>{2, 5, 2, 1, 1, 1, 0});
}
