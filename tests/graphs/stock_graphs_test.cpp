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
