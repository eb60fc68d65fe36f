#include <future>

#include <doctest/doctest.h>

#include "tests/runner/fakes.h"

using namespace terrazzo;
using namespace terrazzo::test;

namespace {

struct Waiting : RunObserver {
  void waits(const Stage& stage) override {
    if (stage.node->name == "quick" && !told.exchange(true)) waits_for_quick.set_value();
  }
  std::atomic<bool> told = false;
  std::promise<void> waits_for_quick;
};

}  // namespace

TEST_CASE("a stage whose values are not stored is left to the process that is at it, too: its names may be enough") {
  const TemporaryFolder folder;
  FakeTypes t;
  Graph graph;
  add(graph, "source", t.number, {{"value", 1.0}});
  add(graph, "quick", t.quick_sum, {{"plus", 2.0}}, {"source"});
  add(graph, "slow", t.sum, {{"plus", 4.0}}, {"quick"});
  Waiting second;
  std::promise<void> begun;
  std::shared_future<void> waits = second.waits_for_quick.get_future().share();
  std::atomic<int> calls = 0;
  t.during_sum = [&](NodeContext&) {
    if (calls++ > 0) return;
    begun.set_value();
    CHECK(waits.wait_for(std::chrono::seconds(60)) == std::future_status::ready);
    CHECK(calls == 1);
  };
  const auto run = [&](RunObserver* observer) {
    Cache cache(folder.path());  // of a process of its own
    RunOptions options = keeping({"slow"}, &cache);
    options.observer = observer;
    const RunResult result = run_graph(graph, options);
    CHECK(result.ok());
    return kept_number(result, "slow");
  };
  std::future<double> first = std::async(std::launch::async, run, nullptr);
  begun.get_future().wait();
  CHECK(run(&second) == 7);
  CHECK(first.get() == 7);
  CHECK(t.runs("sum") == 1);
}
