#include "graphs/document/pack.h"

#include <filesystem>

#include <doctest/doctest.h>

#include "core/file/tar.h"
#include "tests/graphs/document/fake_types.h"
#include "tests/run_node.h"
#include "tests/texts.h"

using namespace terrazzo;
using namespace terrazzo::test;
namespace fs = std::filesystem;

namespace {

/// The made-up types, of which photo reads its file.
const std::vector<NodeType>& reading_types() {
  static const std::vector<NodeType> types = [] {
    std::vector<NodeType> out = fake_types();
    out[0].files_read = [](const Params& p) { return std::vector<fs::path>{std::get<std::string>(p.at("file"))}; };
    return out;
  }();
  return types;
}

/// Packs and loads again from another place.
struct Packed {
  explicit Packed(const fs::path& graph, const std::vector<std::string>& set = {}) {
    files = write_pack(graph, set, {.types = reading_types()}, elsewhere.path() / "p.tzpack");
    place = unpacked(elsewhere.path() / "p.tzpack", elsewhere.path() / "packs");
  }
  Graph load(const std::vector<std::string>& set = {}) const {
    LoadOptions options{.types = reading_types()};
    options.settings = {place / "settings.json"};
    return load_graph_text(read_text(place / "graph.json"), elsewhere.path() / "p.tzpack", set, options).graph;
  }
  TemporaryFolder elsewhere;
  PackedFiles files;
  fs::path place;
};

std::string file_of(const Graph& graph, const std::string& node) {
  const GraphNode* found = graph.find(node);
  REQUIRE_MESSAGE(found, node);
  return read_text(std::get<std::string>(found->params.at("file")));
}

}  // namespace

TEST_CASE("a pack has the graph's inputs, its subgraphs, and the values it was packed with") {
  const TemporaryFolder folder;
  fs::create_directories(folder.path() / "parts");
  write_text(folder.path() / "a.png", "A");
  write_text(folder.path() / "parts/in.png", "IN");
  write_text(folder.path() / "parts/part.json",
             R"({"terrazzo": 1, "nodes": {"n": {"type": "photo", "file": "in.png"}}, "outputs": {"image": "@n"}})");
  write_text(
      folder.path() / "g.json",
      R"({"terrazzo": 1, "parameters": {"image": {"type": "path"}, "out": {"type": "path", "default": "o.png"}, "q": {"type": "int", "default": 1}},
    "nodes": {"a": {"type": "photo", "file": "$image"}, "b": {"type": "parts/part.json"},
    "all": {"type": "gather", "images": ["@a", "@b"]}, "out": {"type": "write", "material": "@all", "path": "$out", "quality": "$q"}}})");
  const Packed packed(folder.path() / "g.json", {"image=" + (folder.path() / "a.png").string(), "q=7"});
  CHECK(packed.files.count == 2);
  CHECK(packed.files.bytes == 3);
  fs::remove_all(folder.path() / "parts");
  fs::remove(folder.path() / "a.png");
  const Graph graph = packed.load();
  CHECK(file_of(graph, "a") == "A");
  CHECK(file_of(graph, "b/n") == "IN");
  CHECK(std::get<int64_t>(graph.find("out")->params.at("quality")) == 7);
  CHECK(std::get<std::string>(graph.find("out")->params.at("path")) == packed.elsewhere.path() / "o.png");
  CHECK(std::get<int64_t>(packed.load({"q=9"}).find("out")->params.at("quality")) == 9);
}

TEST_CASE("loops in a pack find what they found") {
  const TemporaryFolder folder;
  fs::create_directories(folder.path() / "in");
  for (const char* name : {"x", "y"}) write_text(folder.path() / "in" / (std::string(name) + ".png"), name);
  write_text(folder.path() / "rows.csv", "kind\ncolor\nheight\n");
  write_text(
      folder.path() / "g.json",
      R"({"terrazzo": 1, "nodes": {"p": {"type": "photo", "foreach": {"files": "in/*.png", "as": "f"}, "file": "$f"},
    "t": {"type": "photo", "foreach": {"table": "rows.csv"}, "file": "in/x.png", "kind": "$kind"},
    "w": {"type": "write", "foreach": {"files": "in/*.png"}, "material": "@all", "path": "$item_name.png"},
    "all": {"type": "gather", "images": ["@p", "@t"]}}})");
  const Packed packed(folder.path() / "g.json");
  fs::remove_all(folder.path() / "in");
  fs::remove(folder.path() / "rows.csv");
  const Graph graph = packed.load();
  CHECK(graph.nodes.size() == 7);
  CHECK(file_of(graph, "p[x]") == "x");
  CHECK(file_of(graph, "p[y]") == "y");
  CHECK(file_of(graph, "t[height]") == "x");
  CHECK(std::get<std::string>(graph.find("w[y]")->params.at("path")) == packed.elsewhere.path() / "y.png");
}

TEST_CASE("what is no pack, or would leave its folder, is refused") {
  const TemporaryFolder folder;
  const auto archive = [&](const std::vector<std::string>& names) {
    const fs::path path = folder.path() / "p.tzpack";
    TarWriter writer(path);
    for (const std::string& name : names) writer.add(name, "{}");
    writer.finish();
    return path;
  };
  CHECK_THROWS_WITH_AS(unpacked(archive({"x"}), folder.path() / "packs"),
                       ((folder.path() / "p.tzpack").string() +
                        ": expected a pack (terrazzo pack), found an archive without graph.json and settings.json")
                           .c_str(),
                       Error);
  for (const char* name : {"../evil", "/evil", "inputs/../../evil", "inputs/", "other", "inputs/a/../../../evil"}) {
    CAPTURE(name);
    CHECK_THROWS_AS(unpacked(archive({"graph.json", "settings.json", name}), folder.path() / "packs"), Error);
  }
  CHECK_FALSE(fs::exists(folder.path() / "evil"));
  const fs::path place = unpacked(archive({"graph.json", "settings.json", "inputs/0/a"}), folder.path() / "packs");
  CHECK(listing(place) == std::vector<std::string>{"graph.json", "inputs", "settings.json"});
  CHECK(unpacked(folder.path() / "p.tzpack", folder.path() / "packs") == place);
}
