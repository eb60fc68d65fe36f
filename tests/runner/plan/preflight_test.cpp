#include "runner/plan/preflight.h"

#include <doctest/doctest.h>

#include "graphs/document/load.h"
#include "test_paths.h"
#include "tests/runner/fakes.h"
#include "tests/runner/workplace.h"

using namespace terrazzo;
using namespace terrazzo::test;
namespace fs = std::filesystem;

namespace {

/// Photos, a folder of two maps, one of maps of two shapes, cut-off files, a file and a folder that stand in the way, a
/// link to a folder.
struct Surroundings {
  TemporaryFolder folder;
  Surroundings() {
    write_picture(folder.path() / "photo.png", 5);
    write_picture(folder.path() / "maps/stone_basecolor.png", 5);
    write_picture(folder.path() / "maps/stone_normal.png", 7, Semantic::normal);
    write_text(folder.path() / "maps-as-file", "");
    write_picture(folder.path() / "odd/stone_basecolor.png", 5);
    write_picture(folder.path() / "odd/stone_height.png", 5, Semantic::height, {32, 32});
    write_picture(folder.path() / "odd/stone_roughness.png", 5, Semantic::roughness, {64, 48});
    fs::create_directories(folder.path() / "taken.png");
    const std::string whole = read_text(folder.path() / "photo.png");
    fs::create_directories(folder.path() / "torn");
    write_text(folder.path() / "cut.png", whole.substr(0, whole.size() - 20));
    write_text(folder.path() / "torn/rock_color.png", whole.substr(0, whole.size() / 2));
    write_text(folder.path() / "torn/rock_height.png", whole.substr(0, 20));
    fs::create_directory_symlink("maps", folder.path() / "link-to-maps");
  }

  LoadedGraph load(const std::string& text) const { return load_graph_text(text, folder.path() / "graph.json"); }

  /// What planning says, with the folder's name taken out; empty if it is content.
  std::string problems_of(const std::string& text) const {
    std::string out;
    try {
      const LoadedGraph loaded = load(text);
      make_plan(loaded.graph, nullptr);
    } catch (const GraphError& e) {
      out = e.what();
    }
    const std::string mine = folder.path().string();
    for (size_t at; (at = out.find(mine)) != std::string::npos;) out.replace(at, mine.size(), "FOLDER");
    return out;
  }
};

std::string document(const std::string& nodes) {
  return R"({"terrazzo": 1, "nodes": {)" + nodes + "}}";
}

}  // namespace

TEST_CASE("every plan in tests/errors/plans is refused with the message beside it, and nothing is written") {
  const Surroundings around;
  const std::vector<std::string> before = listing(around.folder.path());
  const fs::path goldens = fs::path(TERRAZZO_SOURCE_DIR) / "tests/errors/plans";
  int documents = 0;
  for (const std::string& name : listing(goldens)) {
    if (fs::path(name).extension() != ".json") continue;
    CAPTURE(name);
    documents++;
    check_golden_message(goldens / name, around.problems_of(read_text(goldens / name)),
                         goldens.parent_path() / "README.md");
  }
  CHECK(documents >= 6);
  CHECK(listing(around.folder.path()) == before);
}

TEST_CASE("one map, a chosen map, and maps that are not known yet may go to a path without {map}") {
  const Surroundings around;
  for (const char* nodes : {
           R"("a": {"type": "load_map", "path": "photo.png"},
              "f": {"type": "export", "material": "@a", "path": "out/x.png"})",
           R"("a": {"type": "load_material", "path": "maps"},
              "f": {"type": "export", "material": "@a", "maps": ["normal", "normal"], "path": "out/x.png"})",
           R"("a": {"type": "load_material", "path": "maps", "maps": {"normal": ""}},
              "f": {"type": "export", "material": "@a", "path": "out/x.png"})",
           R"("a": {"type": "load_material", "path": "maps"},
              "f": {"type": "export", "material": "@a", "path": "{material}/{map}_{width}.png"})",
       })
    CHECK(around.problems_of(document(nodes)) == "");
}

TEST_CASE("nodes that are not needed, and sinks whose files are up to date, are not looked at") {
  const Surroundings around;
  const LoadedGraph loaded = around.load(document(R"(
    "a": {"type": "load_map", "path": "photo.png"},
    "f": {"type": "export", "material": "@a", "path": "out/x.png"},
    "g": {"type": "export", "material": "@a", "path": "taken.png"})"));
  PlanOptions only_f;
  only_f.only = {"f"};
  CHECK_THROWS_AS(make_plan(loaded.graph, nullptr), GraphError);
  CHECK_NOTHROW(make_plan(loaded.graph, nullptr, only_f));

  Cache cache(around.folder.path() / "cache");
  RunOptions options;
  options.cache = &cache;
  options.targets = only_f;
  REQUIRE(run_graph(loaded.graph, options).ok());
  fs::permissions(around.folder.path() / "out", fs::perms(0555));
  const Plan plan = make_plan(loaded.graph, &cache, only_f);
  fs::permissions(around.folder.path() / "out", fs::perms(0755));
  CHECK(state(plan, "f") == "up to date");
}

TEST_CASE("shapes go along the wires, and what is not known is no mistake") {
  const Surroundings around;
  const auto chain = [](const char* last) {
    return document(std::string(R"("m": {"type": "load_material", "path": "maps"},
      "all": {"type": "resize", "material": "@m", "size": [32, 32]},
      "color": {"type": "get_map", "material": "@all", "map": "base_color"},
      "grey": {"type": "grayscale", "image": "@color"},
      "mask": {"type": "threshold", "image": "@grey"}, )") +
                    last);
  };
  CHECK(around.problems_of(chain(R"("x": {"type": "distance", "mask": "@mask"})")) == "");
  CHECK(around.problems_of(chain(R"("x": {"type": "distance", "mask": "@color"})"))
            .find("expected an image of 1 channel, found a base_color map of 32x32 pixels and 3 channels") !=
        std::string::npos);
  CHECK(around
            .problems_of(chain(R"("n": {"type": "noise", "size": [16, 16]},
                                    "x": {"type": "blend", "base": "@color", "top": "@n", "mask": "@mask"})"))
            .find("expected the same size as \"base\", 32x32, found 16x16") != std::string::npos);
  CHECK(around.problems_of(chain(R"("x": {"type": "levels", "image": "@color", "gamma": [1, 2]})"))
            .find("alpha, 3; found 2") != std::string::npos);
  CHECK(around.problems_of(chain(R"("x": {"type": "crop", "material": "@all", "size": [48, 8]})"))
            .find("expected a rectangle inside the material of 32x32") != std::string::npos);
}

TEST_CASE("lint stops when it is told to") {
  const TemporaryFolder folder;
  write_picture(folder.path() / "photo.png", 5);
  const Graph graph =
      load_graph_text(document(R"("p": {"type": "load_map", "path": "photo.png"})"), folder.path() / "g.json").graph;
  CHECK_NOTHROW(lint_of(graph, Task()));
  const std::atomic<bool> cancelled = true;
  CHECK_THROWS_AS(lint_of(graph, Task(&cancelled, {})), Cancelled);
}
