#include <algorithm>
#include <filesystem>

#include <doctest/doctest.h>
#include <fmt/format.h>

#include "graphs/document/load.h"
#include "test_paths.h"

using namespace terrazzo;

namespace {

namespace fs = std::filesystem;

std::vector<fs::path> graphs_in(const std::string& folder) {
  std::vector<fs::path> out;
  for (const auto& entry : fs::recursive_directory_iterator(fs::path(TERRAZZO_SOURCE_DIR) / folder))
    if (entry.path().extension() == ".json" && entry.path().stem().extension() != ".schema")
      out.push_back(entry.path());
  std::sort(out.begin(), out.end());
  return out;
}

}  // namespace

TEST_CASE("every graph that comes with the program checks clean and says what it is for") {
  for (const char* folder : {"graphs", "examples"}) {
    const std::vector<fs::path> graphs = graphs_in(folder);
    CHECK(graphs.size() >= 5);
    for (const fs::path& path : graphs) {
      CAPTURE(path.string());
      if (path.parent_path().filename() == "plugin") continue;  // tests/programs_test.sh runs it, with its plug-in
      const LoadedGraph loaded = load_graph(path, {}, {.allow_unset = true});
      for (const Problem& p : loaded.warnings) CHECK_MESSAGE(false, describe(loaded.graph.file, p));
      CHECK(!read_interface(path).summary.empty());
    }
  }
}

TEST_CASE("every stock graph that resolves a uv map lets its user blend seams, as far as the node can") {
  int graphs = 0;
  for (const fs::path& path : graphs_in("graphs")) {
    CAPTURE(path.string());
    const LoadedGraph loaded = load_graph(path, {}, {.allow_unset = true});
    const auto resolves = [](const GraphNode& n) { return n.type->name == "resolve_uv"; };
    const auto node = std::find_if(loaded.graph.nodes.begin(), loaded.graph.nodes.end(), resolves);
    if (node == loaded.graph.nodes.end()) continue;
    graphs++;
    const auto blend = std::find_if(loaded.parameters.begin(), loaded.parameters.end(),
                                    [](const GraphParameter& p) { return p.param.name == "blend"; });
    REQUIRE(blend != loaded.parameters.end());
    CHECK(blend->param.min == node->type->find_param("blend")->min);
    CHECK(blend->param.max == node->type->find_param("blend")->max);
    const LoadedGraph soft = load_graph(path, {override_of("blend", "2.5")}, {.allow_unset = true});
    for (const GraphNode& n : soft.graph.nodes)
      if (resolves(n)) CHECK(std::get<double>(n.params.at("blend")) == 2.5);
  }
  CHECK(graphs == 16);
}

TEST_CASE("stock graphs join heights and let their user choose how far") {
  for (const char* name : {"material", "transfer", "magnify", "extend", "inpaint", "make_tileable", "mix", "variants",
                           "masked", "progression", "labels", "several", "from_analysis"}) {
    CAPTURE(name);
    const fs::path path = fs::path(TERRAZZO_SOURCE_DIR) / "graphs" / (std::string(name) + ".json");
    for (const auto& [overrides, reach] :
         {std::pair(std::vector<std::string>(), 0.03), {std::vector<std::string>{"join=32"}, 32.0}})
      for (const GraphNode& n : load_graph(path, overrides_from(overrides), {.allow_unset = true}).graph.nodes)
        if (n.type->name == "resolve_uv") CHECK(std::get<double>(n.params.at("join")) == reach);
  }
}
