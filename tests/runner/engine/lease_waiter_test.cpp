#include "runner/engine/lease_waiter.h"

#include <doctest/doctest.h>

using namespace terrazzo;
using namespace std::chrono_literals;

namespace {

using Clock = LeaseWaiter::Clock;

/// A waiter whose jobs are leased for as long as the test says so, and what came back from it.
struct Waiting {
  std::atomic<bool> taken{true};
  std::atomic<int> looks{0};
  std::atomic<bool> cancelled{false};
  std::mutex mutex;
  std::condition_variable changed;
  std::vector<std::pair<int, LeaseWaiter::Wait>> back;
  std::optional<LeaseWaiter> waiter;

  Waiting() {
    waiter.emplace(
        [this](const StageJob&) {
          looks++;
          return taken.load();
        },
        [this](const StageJobPtr& job, const LeaseWaiter::Wait& wait) {
          const std::lock_guard lock(mutex);
          back.emplace_back(job->stage, wait);
          changed.notify_all();
        },
        &cancelled);
  }
  void add(int stage) {
    auto job = std::make_shared<StageJob>();
    job->stage = stage;
    waiter->add(std::move(job));
  }
  /// Whether that many jobs have come back, after waiting for them.
  bool came_back(size_t count, std::chrono::milliseconds limit = 20s) {
    std::unique_lock lock(mutex);
    return changed.wait_for(lock, limit, [&] { return back.size() >= count; });
  }
  void look_until(int count) const {
    while (looks < count) std::this_thread::sleep_for(1ms);
  }
};

}  // namespace

TEST_CASE("a job comes back once its stage is free, and says how long it has waited") {
  Waiting w;
  const auto before = Clock::now();
  w.add(7);
  w.look_until(3);
  CHECK_FALSE(w.came_back(1, 0ms));
  w.taken = false;
  REQUIRE(w.came_back(1));
  CHECK(w.back[0].first == 7);
  CHECK(w.back[0].second.start >= before);
  // It looked for the third time after 5 + 10 + 20 ms at the earliest.
  CHECK(w.back[0].second.end - w.back[0].second.start >= 35ms);
}

TEST_CASE("it looks less and less often, but never more seldom than every 200 ms") {
  Waiting w;
  const auto start = Clock::now();
  w.add(0);
  w.look_until(9);
  // After 5, 15, 35, 75, 155, 315, 515, 715 and 915 ms.
  const auto took = Clock::now() - start;
  CHECK(took >= 915ms);
  CHECK(took < 10s);
  w.taken = false;
  CHECK(w.came_back(1));
}

TEST_CASE("jobs come back at once when the run is cancelled, or ends, or a result is there") {
  struct Case {
    const char* what;
    void (*act)(Waiting&);
  };
  const std::vector<Case> cases = {
      {"cancelled", [](Waiting& w) { w.cancelled = true; }},
      {"ends", [](Waiting& w) { w.waiter->give_all_back(); }},
      {"stored",
       [](Waiting& w) {
         w.taken = false;
         w.waiter->look_now();
       }},
      {"gone", [](Waiting& w) { w.waiter.reset(); }},
  };
  for (const Case& c : cases) {
    CAPTURE(c.what);
    Waiting w;
    w.add(0);
    w.add(1);
    w.look_until(14);  // from here on it sleeps for 200 ms
    const auto start = Clock::now();
    c.act(w);
    CHECK(w.came_back(2));
    CHECK(Clock::now() - start < 1s);
    CHECK(w.back.size() == 2);
  }
}

TEST_CASE("a look at all jobs finds nothing, and they go on waiting") {
  Waiting w;
  w.add(0);
  w.look_until(5);
  w.waiter->look_now();
  w.look_until(7);
  CHECK_FALSE(w.came_back(1, 0ms));
  w.waiter->give_all_back();
  CHECK(w.came_back(1));
  const int looks = w.looks;
  w.add(1);
  CHECK(w.came_back(2));
  CHECK(w.looks == looks);
}

TEST_CASE("jobs that wait at once are drawn on different rows, and rows are used again") {
  Waiting w;
  for (int i = 0; i < 3; i++) w.add(i);
  w.taken = false;
  REQUIRE(w.came_back(3));
  std::set<int> rows;
  for (const auto& [stage, wait] : w.back) rows.insert(wait.row);
  CHECK(rows == std::set<int>{0, 1, 2});
  std::this_thread::sleep_for(20ms);
  w.add(3);
  REQUIRE(w.came_back(4));
  CHECK(w.back[3].second.row == 0);
}
