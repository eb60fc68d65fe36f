#include <algorithm>
#include <filesystem>

#include <doctest/doctest.h>
#include <fmt/format.h>

#include "graphs/document/load.h"

using namespace terrazzo;

namespace {

namespace fs = std::filesystem;

std::vector<fs::path> graphs_in(const std::string& folder) {
  std::vector<fs::path> out;
  for (const auto& entry : fs::recursive_directory_iterator(fs::path(TERRAZZO_SOURCE_DIR) / folder))
    if (entry.path().extension() == ".json") out.push_back(entry.path());
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
      const LoadedGraph loaded = load_graph(path, {}, {.allow_unset = true});
      CHECK_MESSAGE(loaded.warnings.empty(), fmt::format("{}", fmt::join(loaded.warnings, "\n")));
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
    const LoadedGraph soft = load_graph(path, {"blend=2.5"}, {.allow_unset = true});
    for (const GraphNode& n : soft.graph.nodes)
      if (resolves(n)) CHECK(std::get<double>(n.params.at("blend")) == 2.5);
  }
  CHECK(graphs == 7);
}

TEST_CASE("stock graphs join heights, but not where parts are to be kept, and let their user choose") {
  for (const auto& [name, reach] :
       {std::pair("material", 0.03), {"transfer", 0.03}, {"magnify", 0.03}, {"inpaint", 0.0}, {"make_tileable", 0.0}}) {
    CAPTURE(name);
    const auto join = [&, name = name](const std::vector<std::string>& overrides) {
      const fs::path path = fs::path(TERRAZZO_SOURCE_DIR) / "graphs" / (std::string(name) + ".json");
      for (const GraphNode& n : load_graph(path, overrides, {.allow_unset = true}).graph.nodes)
        if (n.type->name == "resolve_uv") return std::get<double>(n.params.at("join"));
      return -1.0;
    };
    CHECK(join({}) == reach);
    CHECK(join({"join=32"}) == 32);
  }
}
