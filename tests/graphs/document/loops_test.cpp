#include "graphs/document/loops.h"

#include <filesystem>

#include <doctest/doctest.h>
#include <fmt/format.h>

#include "tests/graphs/document/fake_types.h"
#include "tests/run_node.h"
#include "tests/texts.h"

using namespace terrazzo;
using namespace terrazzo::test;
namespace fs = std::filesystem;

namespace {

LoadedGraph looped(const std::string& loop, const std::string& rest, const std::vector<std::string>& overrides = {},
                   const std::string& path = "/project/test.json") {
  return load_fake(document(fmt::format(R"("p": {{"type": "photo", "foreach": {}, {}}},
                   "all": {{"type": "gather", "images": "@p"}},
                   "out": {{"type": "write", "material": "@all", "path": "x.png"}})",
                                        loop, rest),
                            R"("few": {"type": "numbers", "default": [4, 5]})"),
                   overrides, path);
}

std::vector<std::string> files_of(const LoadedGraph& loaded) {
  std::vector<std::string> out;
  for (const Wire& w : loaded.graph.find("all")->inputs.at("images"))
    out.push_back(std::get<std::string>(loaded.graph.find(w.node)->params.at("file")));
  return out;
}

std::string problem(const std::string& loop) {
  try {
    looped(loop, R"("file": "x")");
  } catch (const GraphError& e) {
    const std::string text = e.what();
    return text.substr(text.find("foreach\": ") + 10);
  }
  return "";
}

}  // namespace

TEST_CASE("a loop makes a node for each value, and its wire stands for all of them") {
  const LoadedGraph loaded = looped(R"({"values": ["x", "y"]})", R"("file": "$item-$item_index.png")");
  CHECK(files_of(loaded) == std::vector<std::string>{"/project/x-0.png", "/project/y-1.png"});
  CHECK(loaded.graph.find("p[x]"));
  CHECK(files_of(looped(R"({"values": "3..1", "as": "n"})", R"("file": "$n.png")")) ==
        std::vector<std::string>{"/project/3.png", "/project/2.png", "/project/1.png"});
  CHECK(files_of(looped(R"({"values": "$few"})", R"("file": "='f' + item * 2 + '.png'")")) ==
        std::vector<std::string>{"/project/f8.png", "/project/f10.png"});
}

TEST_CASE("overrides are for all iterations or for one") {
  const LoadedGraph loaded =
      looped(R"({"values": ["x", "y.z"]})", R"("file": "a.png")", {"p.kind=height", "p[y.z].kind=normal"});
  CHECK(std::get<std::string>(loaded.graph.find("p[x]")->params.at("kind")) == "height");
  CHECK(std::get<std::string>(loaded.graph.find("p[y.z]")->params.at("kind")) == "normal");
  CHECK_THROWS_WITH_AS(
      looped(R"({"values": ["x"]})", R"("file": "a.png")", {"p[w].kind=normal"}),
      "/project/test.json: override \"p[w].kind=normal\": the graph has no node \"p[w]\" (did you mean "
      "\"p[x]\"?)",
      GraphError);
}

TEST_CASE("loops over files, folders and tables") {
  const TemporaryFolder folder;
  for (const char* name : {"scans/a", "scans/b", "scans/.hidden"}) fs::create_directories(folder.path() / name);
  for (const char* name : {"scans/b/m.png", "scans/a/m.png", "scans/c.png", "scans/.hidden/m.png"})
    write_text(folder.path() / name, "x");
  write_text(folder.path() / "rows.csv", "kind,name\nheight,one\nnormal,2\n");
  const std::string path = (folder.path() / "test.json").string();
  const LoadedGraph folders =
      looped(R"({"folders": "scans/*", "as": "scan"})", R"("file": "$scan/$scan_name.png")", {}, path);
  CHECK(files_of(folders) ==
        std::vector<std::string>{folder.path() / "scans/a/a.png", folder.path() / "scans/b/b.png"});
  CHECK(folders.graph.made_from == std::vector<fs::path>{folder.path() / "scans"});
  CHECK(files_of(looped(R"({"files": "scans/*.png"})", R"("file": "$item")", {}, path)) ==
        std::vector<std::string>{folder.path() / "scans/c.png"});
  const LoadedGraph rows =
      looped(R"({"table": "rows.csv", "as": "row"})", R"("file": "$name.png", "kind": "$kind")", {}, path);
  CHECK(files_of(rows) == std::vector<std::string>{folder.path() / "one.png", folder.path() / "2.png"});
  CHECK(std::get<std::string>(rows.graph.find("p[normal]")->params.at("kind")) == "normal");
}

TEST_CASE("a subgraph in a loop") {
  const std::string text =
      R"({"terrazzo": 1, "parameters": {"kinds": {"type": "texts", "default": ["color", "height"]}},
    "graphs": {"g": {"parameters": {"kind": {"type": "text"}}, "nodes": {"p": {"type": "photo", "file": "a.png", "kind": "$kind"},
    "w": {"type": "write", "material": "@p", "path": "$kind.png"}}}},
    "nodes": {"all": {"type": "g", "foreach": {"values": "$kinds", "as": "k"}, "kind": "$k"}}})";
  const LoadedGraph loaded = load_fake(text, {"all[height]/w.quality=5", "all/p.file=b.png"});
  CHECK(loaded.graph.nodes.size() == 4);
  CHECK(std::get<int64_t>(loaded.graph.find("all[height]/w")->params.at("quality")) == 5);
  CHECK(std::get<std::string>(loaded.graph.find("all[color]/p")->params.at("file")).ends_with("/b.png"));
  CHECK(stands_for("all", "all[color]/p"));
  CHECK(stands_for("all[color]", "all[color]/p"));
  CHECK_FALSE(stands_for("al", "all[color]/p"));
  CHECK(nodes_meant(loaded.graph, {"all[height]", "none"}) ==
        std::vector<std::string>{"all[height]/p", "all[height]/w", "none"});
}

TEST_CASE("what is wrong about a loop") {
  CHECK(problem("3").starts_with("expected an object such as {\"folders\": \"scans/*\", \"as\": \"scan\"}"));
  CHECK(problem(R"({"valus": [1]})").starts_with("unknown key \"valus\" (did you mean \"values\"?)"));
  CHECK(problem(R"({"values": [1], "files": "x"})").starts_with("expected one of"));
  CHECK(problem(R"({"values": []})")
            .ends_with("found an empty list; no wire could come from a node without iterations: "
                       "give a value, or remove the node"));
  CHECK(problem(R"({"values": [1, "a"]})").starts_with("expected values of one kind"));
  CHECK(problem(R"({"values": "1..x"})").starts_with("expected a list of values, or a range"));
  CHECK(problem(R"({"values": "1..99999"})").starts_with("more than 10000 variations"));
  CHECK(problem(R"({"values": [1], "as": "few"})").starts_with("the graph has a parameter \"few\" already"));
  CHECK(problem(R"({"folders": "/nowhere/*"})").starts_with("no folder is named like /nowhere/*"));
  CHECK(problem(R"({"table": "/nowhere.csv"})").find("there is no such table") != std::string::npos);
  CHECK(problem(R"({"values": [1], "as": "a b"})").starts_with("expected a name of letters"));
}

TEST_CASE("a pattern that finds nothing is told with the reason, where there is one") {
  const TemporaryFolder folder;
  fs::create_directories(folder.path() / "scans/a");
  write_text(folder.path() / "one.png", "x");
  const auto asked = [&](const std::string& kind, const std::string& pattern) {
    return problem(fmt::format(R"({{"{}": "{}/{}"}})", kind, folder.path().string(), pattern));
  };
  CHECK(asked("folders", "*.png").ends_with("*.png; 1 file is: use \"files\""));
  CHECK(asked("files", "scans/*").ends_with("scans/*; 1 folder is: use \"folders\""));
  CHECK(asked("files", "scan/*/x*.png").ends_with("*.png; there is no folder " + (folder.path() / "scan").string()));
  CHECK(asked("files", "scans/*.png").ends_with("/scans/*.png"));
}

TEST_CASE("a list of texts passes from a parameter to a node") {
  const LoadedGraph loaded = load_fake(
      document(R"("p": {"type": "photo", "file": "a.png"}, "all": {"type": "gather", "images": "@p", "names": "$names"},
                  "out": {"type": "write", "material": "@all", "path": "x"})",
               R"("names": {"type": "texts", "default": ["b", "c"]})"));
  CHECK(std::get<Texts>(loaded.graph.find("all")->params.at("names")) == Texts{"b", "c"});
}

TEST_CASE("a parameter that only the default of another names is used, whatever takes that one's place") {
  const LoadedGraph loaded = load_fake(
      document(
          R"("p": {"type": "photo", "file": "a.png"}, "out": {"type": "write", "material": "@p", "path": "x", "quality": "$q"})",
          R"("half": {"type": "int", "default": 40}, "q": {"type": "int", "default": "=half * 2"})"),
      {"q=7"});
  CHECK(loaded.warnings.empty());
}

TEST_CASE("a port for one wire takes no loop, unless it has one round") {
  const auto text = [](const std::string& values) {
    return document(R"("p": {"type": "photo", "file": "$item.png", "foreach": {"values": )" + values +
                    R"(}}, "out": {"type": "write", "material": "@p", "path": "x.png"})");
  };
  CHECK(problems_of(text(R"(["x"])")).empty());
  CHECK(problems_of(text(R"(["x", "y"])")).ends_with("the port takes one wire, and \"@p\" stands for 2 (a loop)"));
}

TEST_CASE("loops that read loops, and parameters of many uses, are bounded") {
  const std::string loops = document(R"("p": {"type": "photo", "file": "a.png", "foreach": {"values": "1..1100"}},
    "all": {"type": "gather", "images": "@p", "foreach": {"values": "1..1100"}},
    "out": {"type": "write", "material": "@all[1]", "path": "x.png"})");
  CHECK(contains(problems_of(loops), "a graph may have fewer than 1000000 wires"));
  std::string parameters;
  for (int i = 0; i < 300; i++)
    parameters += fmt::format(R"({}"p{}": {{"type": "int", "default": 1}})", i == 0 ? "" : ", ", i);
  const std::string uses = R"({"terrazzo": 1, "graphs": {"sub": {"parameters": {)" + parameters +
                           R"(}, "nodes": {"n": {"type": "photo", "file": "a.png"}}}},
    "nodes": {"all": {"type": "sub", "foreach": {"values": "1..700"}}}})";
  CHECK(contains(problems_of(uses), "the subgraphs of a graph may have at most 200000 parameters together"));
}

TEST_CASE("an iteration's overrides are those of all iterations and its own, in their order") {
  const std::vector<std::string> overrides = {"p[y].kind=normal", "p.kind=height", "p[x].kind=normal"};
  const LoadedGraph loaded = looped(R"({"values": ["x", "y", "z"]})", R"("file": "a.png")", overrides);
  const auto kind = [&](const char* node) { return std::get<std::string>(loaded.graph.find(node)->params.at("kind")); };
  CHECK(kind("p[x]") == "normal");
  CHECK(kind("p[y]") == "height");
  CHECK(kind("p[z]") == "height");
}

TEST_CASE("a round has its loop's variables and the graph's parameters") {
  const std::string text = document(
      R"("p": {"type": "photo", "foreach": {"values": [1, 2]}, "file": "=dir + '/' + item + made + '.png'"},
    "all": {"type": "gather", "images": "@p"}, "out": {"type": "write", "material": "@all", "path": "x.png"})",
      R"("dir": {"type": "text", "default": "in"}, "made": {"type": "text", "default": "=dir + dir"},
    "spare": {"type": "int", "default": 1})");
  const LoadedGraph loaded = load_fake(text, {"dir=a"});
  CHECK(files_of(loaded) == std::vector<std::string>{"/project/graphs/a/1aa.png", "/project/graphs/a/2aa.png"});
  REQUIRE(loaded.warnings.size() == 1);
  CHECK(contains(loaded.warnings[0].where, "spare"));
  CHECK(contains(problems_of(document(R"("p": {"type": "photo", "foreach": {"values": [1]}, "file": "$itm"})")),
                 "did you mean \"item\"?"));
}
