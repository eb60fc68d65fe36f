#include "runner/farm/units.h"

#include <doctest/doctest.h>

#include "runner/farm/arrays.h"
#include "runner/farm/costs.h"
#include "tests/runner/fakes.h"

using namespace terrazzo;
using namespace terrazzo::test;

namespace {

/// file -> space -> index, which is shared; then for each of `count` a layout, and a file of it.
struct Walls {
  TemporaryFolder folder;
  FakeTypes types;
  Cache cache{folder.path() / "cache"};
  Graph graph;

  explicit Walls(int count) {
    write_text(folder.path() / "in.txt", "12");
    add(graph, "exemplar", types.file, {{"path", (folder.path() / "in.txt").string()}});
    add(graph, "space", types.sum, {{"plus", 1.0}}, {"exemplar"});
    add(graph, "index", types.sum, {{"plus", 2.0}}, {"space"});
    for (int i = 0; i < count; i++) {
      const std::string n = std::to_string(i);
      add(graph, "layout" + n, types.sum, {{"plus", 10.0 + i}}, {"index"});
      add(graph, "files" + n, types.write, {{"path", (folder.path() / (n + ".txt")).string()}},
          {"layout" + n, "exemplar"});
    }
  }
  Plan plan() { return make_plan(graph, &cache); }
  void run(const std::vector<std::string>& only) {
    RunOptions options;
    options.targets.only = only;
    options.cache = &cache;
    REQUIRE(run_graph(graph, options).ok());
  }
};

using Names = std::vector<std::string>;

}  // namespace

TEST_CASE("what several units read is a unit, once; what one reads is part of it; what is quick is in each") {
  Walls walls(3);
  const std::vector<Unit> units = units_of(walls.plan());
  REQUIRE(units.size() == 4);
  CHECK(units[0].nodes == Names{"exemplar", "space", "index"});
  CHECK(units[0].targets == Names{"index"});
  CHECK_FALSE(units[0].is_wanted);
  CHECK(units[1].name == "files0");
  CHECK(units[1].nodes == Names{"exemplar", "layout0", "files0"});
  CHECK(units[1].needs == Names{"index"});
  CHECK(units[1].is_wanted);
  CHECK(units[1].kind == units[2].kind);
  CHECK(units[0].kind != units[1].kind);
}

TEST_CASE("slow branches that could be made at the same time are units of their own") {
  Walls walls(0);
  add(walls.graph, "left", walls.types.sum, {{"plus", 4.0}}, {"exemplar"});
  add(walls.graph, "both", walls.types.sum, {}, {"index", "left"});
  Plan plan = walls.plan();
  CHECK(units_of(plan).size() == 1);
  for (Stage& s : plan.stages) s.expected_seconds = seconds_worth_a_task;
  const std::vector<Unit> units = units_of(plan);
  REQUIRE(units.size() == 3);
  CHECK(units[0].nodes == Names{"exemplar", "space", "index"});
  CHECK(units[1].nodes == Names{"exemplar", "left"});
  CHECK(units[2].needs == Names{"index", "left"});
}

TEST_CASE("many pixels take long, more so in better quality, whatever smaller ones have taken") {
  Walls walls(1);
  NodeType& sum = walls.types.sum;
  sum.params.push_back(
      {.name = "quality", .type = ParamType::choice, .fallback = "normal", .choices = {"draft", "normal", "best"}});
  const auto seconds = [&](int side, const char* quality) {
    set(walls.graph, "layout0", "quality", quality);
    Plan plan = walls.plan();
    for (Stage& s : plan.stages)
      if (s.node->name == "layout0") s.shape.size = Size{side, side};
    return units_of(plan).back().seconds;
  };
  const double small = seconds(64, "normal");
  CHECK(small < 10);
  CHECK(seconds(4096, "normal") > 60);
  CHECK(seconds(4096, "draft") < seconds(4096, "normal") / 2);
  CHECK(seconds(4096, "best") > seconds(4096, "normal"));
  // What is there costs nothing.
  walls.run({"files0"});
  CHECK(seconds(4096, "best") == 0);
}

TEST_CASE("what is made is not due, nor is what only that needed") {
  Walls walls(2);
  CHECK(due(units_of(walls.plan()), walls.plan()) == std::vector<bool>{true, true, true});
  walls.run({"index"});
  CHECK(due(units_of(walls.plan()), walls.plan()) == std::vector<bool>{false, true, true});
  walls.run({"files0"});
  CHECK(due(units_of(walls.plan()), walls.plan()) == std::vector<bool>{false, false, true});
  CHECK(units_of(walls.plan()).size() == 3);
  write_text(walls.folder.path() / "0.txt", "edited");
  CHECK(due(units_of(walls.plan()), walls.plan()) == std::vector<bool>{false, true, true});
  walls.run({});
  walls.cache.clear();
  std::filesystem::remove_all(walls.cache.folder() / "v1" / "values");
  const std::vector<bool> is_due = due(units_of(walls.plan()), walls.plan());
  CHECK(is_due[0] == (is_due[1] || is_due[2]));
}

TEST_CASE("arrays: what can run at the same time, split and packed") {
  Walls walls(10);
  const std::vector<Unit> units = units_of(walls.plan());
  const std::vector<bool> all(units.size(), true);
  const std::filesystem::path costs = walls.folder.path() / "costs";

  SUBCASE("a task for each") {
    const auto arrays = arrays_of(units, all, costs, {}, {.limits = {.tasks = 4}, .pack_seconds = 0});
    REQUIRE(arrays.size() == 4);
    CHECK(arrays[0].tasks == std::vector<Names>{{"index"}});
    CHECK(arrays[0].memory == usual_memory);
    CHECK(arrays[1].tasks.size() == 4);
    CHECK(arrays[1].needs == std::vector<size_t>{0});
    CHECK(arrays[3].tasks == std::vector<Names>{{"files8"}, {"files9"}});
    CHECK(arrays[1].id() != arrays[2].id());
  }
  SUBCASE("as many in a task as its time allows, and what earlier ones took") {
    remember_cost(costs, units[1].kind, {10, 35, uint64_t{1} << 30});
    remember_cost(costs, units[1].kind, {10, 35, uint64_t{1} << 20});  // the most counts
    const auto arrays = arrays_of(units, all, costs, {}, {.pack_seconds = 40});
    REQUIRE(arrays.size() == 2);
    CHECK(arrays[1].tasks.size() == 3);
    CHECK(arrays[1].tasks[0] == Names{"files0", "files1", "files2", "files3"});
    CHECK(arrays[1].seconds == 40);
    CHECK(arrays[1].cores == 4);
    CHECK(arrays[1].memory > (uint64_t{1} << 30));
    CHECK(arrays[1].memory < (uint64_t{3} << 29));
  }
  SUBCASE("what is told counts more, and what was killed gets twice as much") {
    const uint64_t gigabyte = uint64_t{1} << 30;
    const auto arrays = arrays_of(units, all, costs, {{"files3", gigabyte}}, {.cores = 3, .memory = gigabyte});
    REQUIRE(arrays.size() == 3);
    CHECK(arrays[1].cores == 3);
    CHECK(arrays[1].memory == gigabyte);
    CHECK(arrays[2].tasks == std::vector<Names>{{"files3"}});
    CHECK(arrays[2].memory == 2 * gigabyte);
  }
  SUBCASE("guesses fit the largest machine") {
    const uint64_t gigabyte = uint64_t{1} << 30;
    remember_cost(costs, units[1].kind, {10, 90, 4 * gigabyte});
    const ArrayOptions options{.limits = {.cores = 4, .memory = gigabyte}};
    const auto arrays = arrays_of(units, all, costs, {{"files3", gigabyte}}, options);
    REQUIRE(arrays.size() == 3);
    CHECK(arrays[1].cores == 4);
    for (const TaskArray& a : arrays) CHECK(a.memory == gigabyte);
  }
  SUBCASE("as many cores as are asked for") {
    CHECK(arrays_of(units, all, costs, {}, {.cores = 64}).front().cores == 64);
  }
  SUBCASE("only what is due") {
    std::vector<bool> some(units.size());
    some[3] = true;
    const auto arrays = arrays_of(units, some, costs, {}, {});
    REQUIRE(arrays.size() == 1);
    CHECK(arrays[0].needs.empty());
  }
}

TEST_CASE("a damaged record of costs is none") {
  const TemporaryFolder folder;
  const Digest kind = Hasher().add("kind").digest();
  remember_cost(folder.path(), kind, {1, 2, 3});
  REQUIRE(cost_of(folder.path(), kind));
  write_text(folder.path() / (kind.hex() + ".json"), R"({"seconds": "many"})");
  CHECK_FALSE(cost_of(folder.path(), kind));
}
