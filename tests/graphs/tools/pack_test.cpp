#include "graphs/tools/pack.h"

#include <algorithm>
#include <filesystem>
#include <memory>

#include <doctest/doctest.h>

#include "core/file/archive.h"
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
    files = write_pack(graph, overrides_from(set), {.types = reading_types()}, elsewhere.path() / "p.tzpack");
    place = unpacked(elsewhere.path() / "p.tzpack", elsewhere.path() / "packs");
  }
  Graph load(const std::vector<std::string>& set = {}, const std::vector<std::string>& presets = {},
             const std::vector<fs::path>& settings = {}) const {
    const LoadOptions options{.types = reading_types(), .presets = presets, .settings = settings, .pack = place};
    return load_graph_text(read_text(place / "graph.json"), elsewhere.path() / "p.tzpack", overrides_from(set), options)
        .graph;
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

TEST_CASE("a pack takes other inputs than its own, however they are given") {
  const TemporaryFolder folder;
  const fs::path at = folder.path();
  for (const char* name : {"one", "two"}) {
    fs::create_directories(at / name);
    for (const char* file : {"a.png", "b.png"}) write_text(at / name / file, std::string(name) + " " + file);
  }
  write_text(at / "part.json",
             R"({"terrazzo": 1, "parameters": {"dir": {"type": "path"}, "file": {"type": "text", "default": "a"}},
    "nodes": {"n": {"type": "photo", "file": "$dir/${file}.png"}}, "outputs": {"image": "@n"}})");
  write_text(at / "g.json", R"({"terrazzo": 1,
    "parameters": {"p": {"type": "path", "default": "one"}, "word": {"type": "text", "default": "a"},
      "list": {"type": "texts", "default": ["one"]}, "fixed": {"type": "path", "default": "=p + '/b.png'"}},
    "presets": {"other": {"set": {"p": ")" +
                                (at / "two").string() + R"("}}},
    "nodes": {"plain": {"type": "photo", "file": "$p/a.png"}, "made": {"type": "photo", "file": "$fixed"},
      "named": {"type": "photo", "file": "one/${word}.png"},
      "sub": {"type": "part.json", "dir": "$p"},
      "files": {"type": "photo", "foreach": {"files": "$p/*.png", "as": "f"}, "file": "$f"},
      "listed": {"type": "photo", "foreach": {"values": "$list"}, "file": "$item/a.png"},
      "same": {"type": "photo", "foreach": {"files": "$p/*.png"}, "file": "one/a.png"},
      "all": {"type": "gather", "images": ["@plain", "@made", "@named", "@sub", "@files", "@listed", "@same"]},
      "w": {"type": "write", "material": "@all", "path": "{map}.png"}}})");
  const Packed packed(at / "g.json");
  fs::rename(at / "one", at / "gone");
  const std::string two = (at / "two").string();

  const auto check_all = [](const Graph& graph, const std::string& from) {
    CHECK(file_of(graph, "plain") == from + " a.png");
    CHECK(file_of(graph, "made") == from + " b.png");
    CHECK(file_of(graph, "sub/n") == from + " a.png");
    CHECK(file_of(graph, "files[b]") == from + " b.png");
    CHECK(file_of(graph, "named") == "one a.png");
    CHECK(file_of(graph, "same[a]") == "one a.png");
  };
  check_all(packed.load(), "one");
  check_all(packed.load({"p=" + two}), "two");
  check_all(packed.load({}, {"other"}), "two");
  write_text(at / "settings.json", R"({"p": "two"})");
  check_all(packed.load({}, {}, {at / "settings.json"}), "two");

  CHECK(file_of(packed.load({"plain.file=" + two + "/b.png"}), "plain") == "two b.png");
  const Graph inner = packed.load({"sub.dir=" + two});
  CHECK(file_of(inner, "sub/n") == "two a.png");
  CHECK(file_of(inner, "plain") == "one a.png");
  CHECK(file_of(packed.load({"fixed=" + two + "/a.png"}), "made") == "two a.png");
  const Graph listed = packed.load({"list=[\"" + two + "\"]"});
  CHECK(std::ranges::count_if(listed.nodes, [](const GraphNode& n) { return n.name.starts_with("listed["); }) == 1);
  CHECK(file_of(listed, "plain") == "one a.png");
  write_text(at / "loop.json", R"({"files.foreach": {"files": "two/b.png", "as": "f"}})");
  const Graph looped = packed.load({}, {}, {at / "loop.json"});
  CHECK(file_of(looped, "files[b]") == "two b.png");
  CHECK_FALSE(looped.find("files[a]"));
  // What the pack does not hold is not taken for what it does.
  CHECK(std::get<std::string>(packed.load({"word=b"}).find("named")->params.at("file")) ==
        (packed.elsewhere.path() / "one/b.png").string());
}

TEST_CASE("loops over files of one name find them again in a pack") {
  const TemporaryFolder folder;
  for (const char* name : {"x", "y"}) {
    fs::create_directories(folder.path() / name);
    write_text(folder.path() / name / "color.png", name);
  }
  write_text(
      folder.path() / "g.json",
      R"({"terrazzo": 1, "nodes": {"p": {"type": "photo", "foreach": {"files": "*/color.*", "as": "f"}, "file": "$f"},
    "all": {"type": "gather", "images": "@p"}, "w": {"type": "write", "material": "@all", "path": "o.png"}}})");
  const Packed packed(folder.path() / "g.json");
  fs::remove_all(folder.path() / "x");
  const Graph graph = packed.load();
  CHECK(file_of(graph, "p[color]") == "x");
  CHECK(file_of(graph, "p[color 2]") == "y");
}

TEST_CASE("a pack writes beside itself, and elsewhere only where it is told to") {
  const TemporaryFolder folder;
  write_text(folder.path() / "a.png", "A");
  const auto packed_with = [&](const std::string& path, const std::string& out) {
    write_text(folder.path() / "g.json", R"({"terrazzo": 1, "parameters": {"out": {"type": "path", "default": ")" +
                                             out +
                                             R"("}, "label": {"type": "text", "default": "x"}},
      "presets": {"far": {"set": {"out": "/elsewhere"}}},
      "nodes": {"a": {"type": "photo", "file": "a.png"}, "w": {"type": "write", "material": "@a", "path": ")" +
                                             path + R"("}}})");
    return std::make_unique<Packed>(folder.path() / "g.json");
  };
  const auto refused = [](const Packed& packed, const std::vector<std::string>& set = {},
                          const std::vector<std::string>& presets = {}) {
    try {
      packed.load(set, presets);
      return std::string();
    } catch (const GraphError& e) {
      return std::string(e.what());
    }
  };
  const auto near = packed_with("$out/{map}.png", "out");
  CHECK(refused(*near) == "");
  CHECK(refused(*near, {"out=/somewhere"}) == "");
  CHECK(refused(*near, {"out=='/somewhere/' + label"}) == "");
  CHECK(refused(*near, {"w.path=/somewhere/{map}.png"}) == "");
  CHECK(contains(refused(*near, {}, {"far"}), "(--set out): may not write /elsewhere/{map}.png"));
  const auto far = packed_with("$out/{map}.png", "/elsewhere");
  CHECK(contains(refused(*far), "a pack writes only into its own folder"));
  CHECK(refused(*far, {"out=/somewhere"}) == "");
  CHECK_FALSE(refused(*packed_with("../{map}.png", "out")).empty());
  // Only a path opens a place, and only that.
  CHECK_FALSE(refused(*packed_with("/elsewhere/$label.png", "out"), {"label=y"}).empty());
  CHECK_FALSE(refused(*packed_with("/elsewhere/$out.png", "out"), {"out=y"}).empty());
  CHECK(refused(*packed_with("${out}_{map}.png", "out"), {"out=/somewhere/wall"}) == "");
  CHECK_FALSE(refused(*packed_with("${out}side/{map}.png", "out"), {"out=/somewhere/out"}).empty());
  CHECK_FALSE(refused(*packed_with("${out}{map}/x.png", "out"), {"out=/somewhere/out"}).empty());
  // The folder's own name is no beginning of other names.
  for (const char* rest : {"{map}.png", "-{map}.png", "-x.png"}) {
    const auto beside = packed_with("$out.png", "out");
    const std::string sibling = beside->elsewhere.path().string() + rest;
    CAPTURE(sibling);
    std::string text = read_text(beside->place / "graph.json");
    text.replace(text.find("$out.png"), 8, sibling);
    write_text(beside->place / "graph.json", text);
    CHECK(contains(refused(*beside), "may not write " + sibling));
  }
}

TEST_CASE("a copy of a pack that has lost, gained or changed something is mended") {
  const TemporaryFolder folder;
  write_text(folder.path() / "a.png", "A");
  write_text(folder.path() / "g.json",
             R"({"terrazzo": 1, "nodes": {"a": {"type": "photo", "file": "a.png"},
    "w": {"type": "write", "material": "@a", "path": "o.png"}}})");
  const Packed packed(folder.path() / "g.json");
  const fs::path input = packed.place / "inputs/1/a.png";
  const auto again = [&] { return unpacked(packed.elsewhere.path() / "p.tzpack", packed.elsewhere.path() / "packs"); };
  const auto check_whole = [&] {
    CHECK(again() == packed.place);
    CHECK(fs::is_regular_file(fs::symlink_status(input)));
    CHECK(read_text(input) == "A");
    CHECK(listing(packed.place / "inputs/1") == std::vector<std::string>{"a.png"});
    CHECK(file_of(packed.load(), "a") == "A");
  };
  fs::remove(input);
  check_whole();
  write_text(input, "B");
  check_whole();
  write_text(input, "longer");
  check_whole();
  write_text(packed.place / "inputs/1/normal.png", "N");
  check_whole();
  fs::remove_all(packed.place / "inputs");
  check_whole();
  write_text(folder.path() / "same.png", "A");
  fs::remove(input);
  fs::create_symlink(folder.path() / "same.png", input);
  check_whole();
  fs::remove(input);
  fs::create_directories(input / "x");
  check_whole();
  fs::create_directories(folder.path() / "inputs/1");
  write_text(folder.path() / "inputs/1/a.png", "A");
  fs::remove_all(packed.place / "inputs");
  fs::create_symlink(folder.path() / "inputs", packed.place / "inputs");
  check_whole();
  CHECK(read_text(folder.path() / "inputs/1/a.png") == "A");
  for (const char* own : {"graph.json", "settings.json", "sources.json"}) {
    const std::string before = read_text(packed.place / own);
    write_text(packed.place / own, "{}");
    check_whole();
    CHECK(read_text(packed.place / own) == before);
  }
  fs::remove_all(packed.place);
  write_text(packed.place, "a file in its place");
  check_whole();
}

TEST_CASE("a subgraph that is called otherwise in a pack is told") {
  const TemporaryFolder folder;
  fs::create_directories(folder.path() / "my parts");
  write_text(folder.path() / "a.png", "A");
  write_text(folder.path() / "my parts/wall 10% #2.json",
             R"({"terrazzo": 1, "nodes": {"n": {"type": "photo", "file": "../a.png"}}, "outputs": {"image": "@n"}})");
  write_text(folder.path() / "g.json", R"({"terrazzo": 1, "nodes": {"b": {"type": "my parts/wall 10% #2.json"},
    "w": {"type": "write", "material": "@b", "path": "o.png"}}})");
  const Packed packed(folder.path() / "g.json");
  REQUIRE(packed.files.renamed.size() == 1);
  CHECK(contains(packed.files.renamed[0], "my parts/wall 10% #2.json is called wall_10___2 in the pack"));
  CHECK(file_of(packed.load(), "b/n") == "A");
}

TEST_CASE("what is no pack, or would leave its folder, is refused") {
  const TemporaryFolder folder;
  const auto archive = [&](const std::vector<std::string>& names) {
    const fs::path path = folder.path() / "p.tzpack";
    const std::unique_ptr<ArchiveWriter> writer = write_archive(path);
    for (const std::string& name : names) writer->add(name, "{}");
    writer->finish();
    return path;
  };
  CHECK_THROWS_WITH_AS(unpacked(archive({"x"}), folder.path() / "packs"),
                       ((folder.path() / "p.tzpack").string() +
                        ": expected a pack (terrazzo pack), found an archive without graph.json and settings.json")
                           .c_str(),
                       Error);
  for (const char* name : {"../evil", "/evil", "inputs/../../evil", "inputs/", "other", "inputs/a/../../../evil",
                           "inputs/.", "inputs/a/."}) {
    CAPTURE(name);
    CHECK_THROWS_AS(unpacked(archive({"graph.json", "settings.json", name}), folder.path() / "packs"), Error);
  }
  for (const std::vector<std::string>& both :
       {std::vector<std::string>{"inputs/1/a", "inputs/1"}, {"inputs/1", "inputs/1/b/a"}}) {
    const fs::path path = archive({"graph.json", "settings.json", both[0], both[1]});
    CHECK_THROWS_WITH_AS(unpacked(path, folder.path() / "packs"),
                         doctest::Contains("p.tzpack: the pack holds \"inputs/1\" as a file and as a folder"), Error);
  }
  CHECK_FALSE(fs::exists(folder.path() / "packs"));
  CHECK_FALSE(fs::exists(folder.path() / "evil"));
  const fs::path place = unpacked(archive({"graph.json", "settings.json", "inputs/0/a"}), folder.path() / "packs");
  CHECK(listing(place) == std::vector<std::string>{"graph.json", "inputs", "settings.json"});
  CHECK(unpacked(folder.path() / "p.tzpack", folder.path() / "packs") == place);
}

TEST_CASE("a pack whose sources are lost or damaged does not take what it is told for what it has") {
  const TemporaryFolder folder;
  write_text(folder.path() / "a.png", "A");
  write_text(folder.path() / "b.png", "B");
  write_text(folder.path() / "g.json",
             R"({"terrazzo": 1, "parameters": {"p": {"type": "path", "default": "a.png"}},
    "nodes": {"a": {"type": "photo", "file": "$p"}, "w": {"type": "write", "material": "@a", "path": "o.png"}}})");
  const Packed packed(folder.path() / "g.json");
  const std::string other = (folder.path() / "b.png").string();
  fs::remove(packed.place / "sources.json");
  CHECK(file_of(packed.load(), "a") == "A");
  CHECK(file_of(packed.load({"a.file=" + other}), "a") == "B");
  CHECK_THROWS_WITH_AS(packed.load({"p=" + other}), doctest::Contains("Pack it again"), GraphError);
  for (const char* damaged : {R"({"a.file": "p"})", R"(["p"])", R"({"a.file": [1]})", R"({"a.file": [)", "3"}) {
    CAPTURE(damaged);
    write_text(packed.place / "sources.json", damaged);
    CHECK_THROWS_AS(packed.load({"p=" + other}), GraphError);
    CHECK_THROWS_AS(packed.load(), GraphError);
  }
}
