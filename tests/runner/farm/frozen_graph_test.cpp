#include "runner/farm/frozen_graph.h"

#include <doctest/doctest.h>

#include "core/file/file_io.h"
#include "graphs/document/load.h"
#include "graphs/values/variations.h"
#include "runner/farm/farm_folder.h"
#include "runner/plan/planning.h"
#include "test_paths.h"
#include "tests/runner/workplace.h"
#include "tests/texts.h"

using namespace terrazzo;
using namespace terrazzo::test;
namespace fs = std::filesystem;

namespace {

Graph graph_of(const Workplace& w, const std::string& nodes, const std::string& name = "graph.json") {
  write_text(w.path / name, R"({"terrazzo": 1, "nodes": {)" + nodes + "}}");
  return load_graph(w.path / name).graph;
}

/// A plan, frozen and written; and what the document says when it is read again.
struct Frozen {
  Graph before;
  FrozenGraph graph;
  fs::path job;
  Graph after;
  Plan plan_before, plan_after;

  Frozen(const Workplace& w, Graph given, const PlanOptions& options = {}) : before(std::move(given)) {
    plan_before = make_plan(before, nullptr, options);
    graph = frozen(plan_before, nullptr);
    job = FarmFolder(w.path / "cache").jobs() / "job";
    write_frozen(graph, job);
    after = load_graph(job / "graph.json").graph;
    plan_after = make_plan(after, nullptr, {.only = graph.targets});
  }

  /// Nodes whose key is another than before, and how many have the same.
  std::pair<std::vector<std::string>, int> compared() const {
    std::pair<std::vector<std::string>, int> out;
    for (const Stage& s : plan_before.stages) {
      if (!s.needed || !s.known) continue;
      const std::string& name = graph.names.at(s.node->name);
      const auto same = [&](const Stage& t) { return t.node->name == name && t.known && t.known->key == s.known->key; };
      if (std::ranges::any_of(plan_after.stages, same))
        out.second++;
      else
        out.first.push_back(name);
    }
    return out;
  }
};

}  // namespace

TEST_CASE("a frozen graph has the keys of the graph, though its files are copies") {
  const Workplace w;
  write_picture(w.path / "wall" / "wall_height.png", 1, Semantic::height);
  write_picture(w.path / "wall" / "wall_basecolor.png", 2);
  const Frozen f(w, graph_of(w, R"("exemplar": {"type": "load_material", "path": "wall"},
      "one": {"type": "load_map", "path": "wall/wall_basecolor.png"},
      "soft": {"type": "blur", "image": "@one", "radius": 2.5},
      "out": {"type": "export", "material": "@soft", "path": "out/{map}.png"},
      "more": {"type": "export", "material": "@exemplar", "path": "more/{map}.png"})"));
  const auto [others, same] = f.compared();
  CHECK(others.empty());
  CHECK(same >= 2);
  CHECK(f.graph.inputs.size() == 3);

  SUBCASE("the originals may go") {
    fs::remove_all(w.path / "wall");
    CHECK_NOTHROW(make_plan(load_graph(f.job / "graph.json").graph, nullptr));
  }
  SUBCASE("the same again is the same job; another picture, another") {
    CHECK(frozen(f.plan_before, nullptr).id == f.graph.id);
    write_picture(w.path / "wall" / "wall_basecolor.png", 3);
    CHECK(frozen(f.plan_before, nullptr).id != f.graph.id);
  }
  SUBCASE("a file that changes while it is copied") {
    fs::remove_all(FarmFolder::of_job(f.job).inputs());
    write_picture(w.path / "wall" / "wall_basecolor.png", 3);
    CHECK_THROWS_WITH_AS(write_frozen(f.graph, f.job), doctest::Contains("has changed while it was copied"), FileError);
  }
}

TEST_CASE("only what is needed is frozen, and results still go where they did") {
  const Workplace w;
  write_picture(w.path / "a.png", 1);
  write_picture(w.path / "b.png", 2);
  const Frozen f(w,
                 graph_of(w, R"("a": {"type": "load_map", "path": "a.png"}, "b": {"type": "load_map", "path": "b.png"},
      "x": {"type": "export", "material": "@a", "path": "x.png"}, "y": {"type": "export", "material": "@b", "path": "y.png"})"),
                 {.only = {"x"}});
  CHECK(f.after.nodes.size() == 2);
  CHECK(f.graph.targets == std::vector<std::string>{"x"});
  CHECK(std::get<std::string>(f.after.find("x")->params.at("path")) == (w.path / "x.png").string());
}

TEST_CASE("names that wires cannot have, and texts that mean something in documents") {
  const Workplace w;
  write_picture(w.path / "a.png", 1);
  const auto variation = [&](const std::string& caption, int number) {
    return graph_of(w, R"("a": {"type": "load_map", "path": "a.png"},
      "sheet": {"type": "contact_sheet", "images": ["@a"], "captions": [)" +
                           caption + R"(]}, "file": {"type": "export", "material": "@sheet", "path": "s$$/)" +
                           std::to_string(number) + R"(/{map}.png"})");
  };
  const MergedGraph all = merged({variation(R"("@@a")", 1), variation(R"("==1")", 2), variation(R"("costs $$5")", 3)},
                                 {"c=@a, d=0.5", "c==1", "c=$5"});
  const Frozen f(w, all.graph);
  CHECK(f.compared().first.empty());
  CHECK(f.compared().second >= 1);
  std::set<std::string> captions;
  for (const GraphNode& n : f.after.nodes)
    if (n.type->name == "contact_sheet") captions.insert(std::get<Texts>(n.params.at("captions")).front());
  CHECK(captions == std::set<std::string>{"@a", "=1", "costs $5"});
}

TEST_CASE("every graph that comes with the program keeps its keys") {
  const Workplace w;
  write_picture(w.path / "wall" / "wall_height.png", 1, Semantic::height, {64, 64});
  write_picture(w.path / "wall" / "wall_basecolor.png", 2, Semantic::base_color, {64, 64});
  int graphs = 0;
  for (const char* name : {"material", "texture", "variants", "make_tileable", "analyse", "engine"}) {
    const fs::path file = fs::path(TERRAZZO_SOURCE_DIR) / "graphs" / (std::string(name) + ".json");
    std::vector<Override> values;
    for (const GraphParameter& p : load_graph(file, {}, {.allow_unset = true}).parameters) {
      if (p.value || p.param.type != ParamType::path) continue;
      const bool is_map = p.param.name == "map" || p.param.name == "image";
      values.push_back(override_of(p.param.name, w.path / (is_map ? "wall/wall_basecolor.png" : "wall")));
    }
    const Frozen f(w, load_graph(file, values).graph);
    graphs++;
    CHECK(f.compared().first.empty());
    CHECK(f.compared().second > 0);
  }
  CHECK(graphs == 6);
}
