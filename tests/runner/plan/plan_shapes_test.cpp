#include "runner/plan/plan_shapes.h"

#include <doctest/doctest.h>

#include "graphs/document/load.h"
#include "runner/plan/planning.h"
#include "tests/run_node.h"

using namespace terrazzo;
using namespace terrazzo::test;

namespace {

/// The shapes of the nodes of a document, in its order.
std::vector<std::string> shapes(const std::string& nodes) {
  const TemporaryFolder folder;
  const LoadedGraph loaded =
      load_graph_text(R"({"terrazzo": 1, "nodes": {)" + nodes + "}}", folder.path() / "graph.json");
  std::vector<std::string> out;
  for (const Stage& s : make_plan(loaded.graph, nullptr).stages) out.push_back(s.node->name + " " + describe(s.shape));
  return out;
}

}  // namespace

TEST_CASE("a plan tells the sizes and channels of images, materials, analyses and uv maps") {
  CHECK(shapes(R"("a": {"type": "pattern", "size": [96, 64]},
    "b": {"type": "get_map", "material": "@a", "map": "normal"},
    "c": {"type": "weight", "material": "@a"},
    "d": {"type": "pca", "features": "@c"},
    "e": {"type": "index", "appearance": "@d"},
    "f": {"type": "synthesize", "index": "@e", "size": [40, 30]},
    "g": {"type": "variants", "material": "@a", "rotations": [90], "gap": 0},
    "h": {"type": "preview", "material": "@a"})") == std::vector<std::string>{"a 96x64 9ch", "b 96x64 3ch", "c 96x64",
                                                                              "d 96x64", "e 96x64", "f 40x30",
                                                                              "g 160x96 9ch", "h 512x512 3ch"});
}

TEST_CASE("what is not known is left out") {
  CHECK(describe(PlanShape{}) == "-");
  CHECK(describe(PlanShape{std::nullopt, 3}) == "3ch");
  CHECK(describe(PlanShape{Size{8, 4}, std::nullopt}) == "8x4");
}
