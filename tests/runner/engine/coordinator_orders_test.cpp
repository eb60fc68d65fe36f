#include <cmath>

#include <doctest/doctest.h>
#include <fmt/format.h>

#include "runner/engine/coordinator.h"
#include "tests/runner/engine/dice.h"
#include "tests/runner/fakes.h"

/// Whole runs without threads, in which jobs end in any order, stored results are unreadable and other processes are
/// busy as the dice have it.
using namespace terrazzo;
using namespace terrazzo::test;

namespace {

constexpr int stages = 24;

Graph random_graph(const FakeTypes& t, Dice& dice) {
  const std::array<const NodeType*, 4> types = {&t.sum, &t.quick_sum, &t.lazy_sum, &t.tens};
  Graph g;
  for (int i = 0; i < stages; i++) {
    std::vector<std::string> in;
    for (int k = i == 0 ? 0 : dice.roll(4); k > 0; k--) in.push_back(fmt::format("n{}", dice.roll(i)));
    add(g, fmt::format("n{}", i), *types[size_t(dice.roll(4))], {{"plus", double(dice.roll(5))}}, in);
  }
  return g;
}

/// What each node gives.
std::vector<double> expected_numbers(const Graph& g, const FakeTypes& t) {
  std::map<std::string, double> numbers;
  std::vector<double> all;
  for (const GraphNode& n : g.nodes) {
    double sum = 0;
    if (n.inputs.count("in") == 1)
      for (const Wire& w : n.inputs.at("in")) sum += numbers.at(w.node);
    numbers[n.name] = n.type == &t.tens ? std::floor(sum / 10) : sum + std::get<double>(n.params.at("plus"));
    all.push_back(numbers[n.name]);
  }
  return all;
}

/// What happened to jobs on the way.
struct Seen {
  int busy = 0, unreadable = 0, loads = 0, runs = 0;
};

class Driver {
 public:
  Driver(const Graph& graph, const RunOptions& options, Dice& dice, Seen& seen)
      : options_(options),
        dice_(dice),
        seen_(seen),
        plan_(make_plan(graph, options.cache, options.targets)),
        coordinator_(plan_, options, 1 + dice.roll(4), uint64_t(dice.roll(40))) {}

  void run() {
    tell(std::make_shared<StageJob>());
    while (!running_.empty() || !postponed_.empty()) {
      const bool resumes = running_.empty() || (!postponed_.empty() && dice_.roll(3) == 0);
      std::vector<StageJobPtr>& from = resumes ? postponed_ : running_;
      const auto at = from.begin() + dice_.roll(int(from.size()));
      const StageJobPtr job = *at;
      from.erase(at);
      if (resumes)
        job->resumed = true;
      else
        work(*job);
      tell(job);
    }
  }

  Coordinator& coordinator() { return coordinator_; }
  const Plan& plan() const { return plan_; }

 private:
  void work(StageJob& job) {
    if ((job.kind == StageJob::Kind::compute || job.kind == StageJob::Kind::look_up) && dice_.roll(4) == 0) {
      seen_.busy++;
      job.busy = true;
      return;
    }
    if (job.kind == StageJob::Kind::load && dice_.roll(3) == 0) {
      seen_.unreadable++;
      return;
    }
    seen_.loads += job.kind == StageJob::Kind::load;
    seen_.runs += job.kind == StageJob::Kind::compute;
    perform(job, plan_, options_);
    REQUIRE_FALSE(job.failure);
  }
  void tell(const StageJobPtr& job) {
    coordinator_.settle(job);
    for (StageJobPtr& j : coordinator_.admit()) running_.push_back(std::move(j));
    for (StageJobPtr& j : coordinator_.take_postponed()) postponed_.push_back(std::move(j));
  }

  const RunOptions& options_;
  Dice& dice_;
  Seen& seen_;
  Plan plan_;
  Coordinator coordinator_;
  std::vector<StageJobPtr> running_, postponed_;
};

void check_end(Driver& driver, const Graph& g, const FakeTypes& t) {
  const StageStates& states = driver.coordinator().states();
  const std::vector<StageOutcome> outcomes = driver.coordinator().outcomes().take_stages();
  uint64_t kept_bytes = 0;
  for (int i = 0; i < stages; i++) {
    const Stage& s = driver.plan().stages[size_t(i)];
    REQUIRE(outcomes[size_t(i)].kind != StageOutcome::Kind::unfinished);
    REQUIRE(outcomes[size_t(i)].kind != StageOutcome::Kind::failed);
    if (!s.needed) continue;
    REQUIRE(states.name(i) == NameState::named);
    REQUIRE(states.value(i) == (s.kept ? ValueState::held : ValueState::resting));
    kept_bytes += s.kept ? sizeof(float) : 0;
  }
  // Recipes have no pixels, and images from the cache lie there.
  REQUIRE(driver.coordinator().held_memory() <= kept_bytes + stages * sizeof(float));
  const std::vector<double> expected = expected_numbers(g, t);
  const auto kept = driver.coordinator().take_kept();
  REQUIRE(kept.size() == 2);
  for (size_t i = 0; i < stages; i++)
    if (kept.count(g.nodes[i].name) == 1) {
      const ImagePtr image = std::get<ImagePtr>(kept.at(g.nodes[i].name).at("out"));
      REQUIRE(image->pixels().at(0) == expected[i]);
    }
}

}  // namespace

TEST_CASE("whatever ends first, is damaged or busy, a run comes to its end with the right values") {
  Seen seen;
  for (uint64_t seed = 1; seed <= 40; seed++) {
    CAPTURE(seed);
    Dice dice(seed);
    FakeTypes t;
    const TemporaryFolder folder;
    Cache cache(folder.path());
    Graph g = random_graph(t, dice);
    for (int round = 0; round < 4; round++) {
      CAPTURE(round);
      const std::string last = fmt::format("n{}", stages - 1), other = fmt::format("n{}", dice.roll(stages - 1));
      const RunOptions options = keeping({last, other}, seed % 5 == 0 ? nullptr : &cache);
      Driver driver(g, options, dice, seen);
      driver.run();
      check_end(driver, g, t);
      set(g, fmt::format("n{}", dice.roll(stages)), "plus", double(dice.roll(5)));
    }
  }
  CHECK(seen.busy > 100);
  CHECK(seen.unreadable > 20);
  CHECK(seen.loads > 50);
  CHECK(seen.runs > 500);
}
