#include "graphs/document/load.h"

#include <algorithm>
#include <filesystem>
#include <fstream>

#include <doctest/doctest.h>
#include <fmt/format.h>

#include "tests/graphs/document/fake_types.h"
#include "tests/run_node.h"

using namespace terrazzo;
using namespace terrazzo::test;
namespace fs = std::filesystem;

namespace {

const std::string photo_a = R"("a": {"type": "photo", "file": "maps/a.png"})";

template <typename T>
T param_of(const LoadedGraph& loaded, const std::string& node, const std::string& param) {
  const GraphNode* found = loaded.graph.find(node);
  REQUIRE(found);
  return std::get<T>(found->params.at(param));
}

/// The values of a node of type adjust whose one parameter is written as `entry`.
template <typename T>
T adjusted(const std::string& param, const std::string& json, const std::vector<std::string>& overrides = {},
           const std::string& parameters = "") {
  const std::string node = fmt::format(R"(, "b": {{"type": "adjust", "image": "@a", "{}": {}}})", param, json);
  return param_of<T>(load_fake(document(photo_a + node, parameters), overrides), "b", param);
}

std::vector<std::string> order_of(const Graph& graph) {
  std::vector<std::string> names;
  for (const GraphNode& n : graph.nodes) names.push_back(n.name);
  return names;
}

}  // namespace

TEST_CASE("a document becomes a graph with all parameters filled in") {
  const LoadedGraph loaded = load_fake(
      R"({"terrazzo": 1, "$schema": "graph.schema.json", "summary": "Two maps", "help": "How to.",
          "parameters": {"steps": {"type": "int", "default": 3, "help": "How often.", "min": 1}},
          "nodes": {
            "photo": {"type": "photo", "file": "a.png"},
            "soft": {"type": "adjust", "image": "@photo", "steps": "$steps"},
            "set": {"type": "gather", "images": ["@photo", "@soft.image"], "gains": {"x": 2, "y": [1, 0.5]}},
            "files": {"type": "write", "material": "@set", "path": "out/{map}.png"}}})");
  CHECK(loaded.graph.summary == "Two maps");
  CHECK(loaded.help == "How to.");
  CHECK(loaded.graph.file == "/project/graphs/test.json");
  CHECK(param_of<int64_t>(loaded, "soft", "steps") == 3);
  CHECK(param_of<double>(loaded, "soft", "amount") == 0.5);
  CHECK(param_of<Size>(loaded, "soft", "size") == Size{256, 128});
  CHECK(param_of<NumberMap>(loaded, "set", "gains") == NumberMap{{"x", {2}}, {"y", {1, 0.5}}});
  const std::vector<Wire>& images = loaded.graph.find("set")->inputs.at("images");
  REQUIRE(images.size() == 2);
  CHECK(images[0].node == "photo");
  CHECK(images[1].node == "soft");
  CHECK(images[1].port == "image");
  CHECK_FALSE(loaded.graph.find("soft")->inputs.contains("mask"));
  CHECK(loaded.graph.find("files")->place.line == 7);
  CHECK(loaded.warnings.empty());
  CHECK(loaded.conversions.empty());
}

TEST_CASE("values take the forms that their types allow") {
  CHECK(adjusted<Size>("size", "[512, 64]") == Size{512, 64});
  CHECK(adjusted<Size>("size", "\"64x512\"") == Size{64, 512});
  CHECK(adjusted<Size>("size", "32") == Size{32, 32});
  CHECK(adjusted<int64_t>("steps", "2e1") == 20);
  CHECK(adjusted<double>("amount", "1") == 1.0);
  CHECK(adjusted<bool>("wrap", "true"));
}

TEST_CASE("relative paths lie beside the graph file, those of overrides in the working folder") {
  const std::string text =
      document(R"("a": {"type": "photo", "file": "$p"}, "b": {"type": "photo", "file": "../maps/./b.png"})",
               R"("p": {"type": "path", "default": "maps/a/"})");
  const std::string here = fs::current_path().string();
  const LoadedGraph plain = load_fake(text);
  CHECK(param_of<std::string>(plain, "a", "file") == "/project/graphs/maps/a");
  CHECK(param_of<std::string>(plain, "b", "file") == "/project/maps/b.png");
  const LoadedGraph set = load_fake(text, {"p=x/y.png", "b.file=z.png"});
  CHECK(param_of<std::string>(set, "a", "file") == here + "/x/y.png");
  CHECK(param_of<std::string>(set, "b", "file") == here + "/z.png");
  CHECK(param_of<std::string>(load_fake(text, {"p=/abs"}), "a", "file") == "/abs");
  CHECK(param_of<std::string>(load_fake(text, {}, "graphs/test.json"), "a", "file") == here + "/graphs/maps/a");
}

TEST_CASE("an empty path stays empty where the node allows it") {
  CHECK(adjusted<std::string>("config", "\"\"") == "");
  CHECK(adjusted<std::string>("config", "\"c.ocio\"") == "/project/graphs/c.ocio");
}

TEST_CASE("a parameter inside a longer text is written out") {
  const std::string parameters =
      R"("out": {"type": "path", "default": "out"}, "seed": {"type": "int", "default": 7}, "size": {"type": "size", "default": 64},
         "f": {"type": "number", "default": 0.25}, "name": {"type": "text", "default": "brick"}, "b": {"type": "bool", "default": true})";
  const auto path = [&](const std::string& text, const std::vector<std::string>& overrides = {}) {
    return param_of<std::string>(
        load_fake(document(fmt::format(R"("a": {{"type": "photo", "file": "{}"}})", text), parameters), overrides), "a",
        "file");
  };
  CHECK(path("$out/$name-$seed/{map}.png") == "/project/graphs/out/brick-7/{map}.png");
  CHECK(path("${name}_$size.png") == "/project/graphs/brick_64x64.png");
  CHECK(path("maps/$out/$f$b") == "/project/graphs/maps/out/0.25true");
  CHECK(path("$out/x", {"out=here"}) == fs::current_path().string() + "/here/x");
  CHECK(path("5$$ @home") == "/project/graphs/5$ @home");
  CHECK(path("@@home/a@@b") == "/project/graphs/@home/a@@b");
}

TEST_CASE("a parameter alone keeps its type") {
  CHECK(adjusted<Size>("size", "\"$s\"", {}, R"("s": {"type": "size", "default": "32x64"})") == Size{32, 64});
  CHECK(adjusted<double>("amount", "\"$n\"", {}, R"("n": {"type": "number", "default": 0.25})") == 0.25);
  CHECK(adjusted<std::string>("label", "\"$n\"", {}, R"("n": {"type": "number", "default": 0.25})") == "0.25");
  CHECK(adjusted<bool>("wrap", "\"$w\"", {"w=true"}, R"("w": {"type": "bool", "default": false})"));
  const LoadedGraph loaded = load_fake(document(
      photo_a +
          R"(, "g": {"type": "gather", "images": "@a", "gains": "$g", "weights": ["$w", 2], "names": ["x", "$w"]})",
      R"("g": {"type": "number_map", "default": {"x": [1, 2], "y": 3}}, "w": {"type": "int", "default": 5})"));
  CHECK(param_of<NumberMap>(loaded, "g", "gains") == NumberMap{{"x", {1, 2}}, {"y", {3}}});
  CHECK(param_of<Numbers>(loaded, "g", "weights") == Numbers{5, 2});
  CHECK(param_of<Texts>(loaded, "g", "names") == Texts{"x", "5"});
}

TEST_CASE("overrides reach parameters of the graph, of nodes, and ports") {
  const std::string text = document(photo_a + R"(, "c": {"type": "photo", "file": "c.png"},
        "b": {"type": "adjust", "image": "@a", "steps": "$n"}, "g": {"type": "gather", "images": "@a"})",
                                    R"("n": {"type": "int", "default": 2})");
  const LoadedGraph loaded =
      load_fake(text, {"n=9", "n=8", "b.size=32x16", "b.label=5", "b.image=@c", "b.mask=@a.image",
                       "g.images=[\"@b\", \"@c\"]", "g.gains={\"x\": 2}", "g.names=[\"p=q\"]"});
  CHECK(param_of<int64_t>(loaded, "b", "steps") == 8);
  CHECK(param_of<Size>(loaded, "b", "size") == Size{32, 16});
  CHECK(param_of<std::string>(loaded, "b", "label") == "5");
  CHECK(loaded.graph.find("b")->inputs.at("image")[0].node == "c");
  CHECK(loaded.graph.find("b")->inputs.at("mask")[0].node == "a");
  CHECK(loaded.graph.find("g")->inputs.at("images").size() == 2);
  CHECK(param_of<NumberMap>(loaded, "g", "gains") == NumberMap{{"x", {2}}});
  CHECK(param_of<Texts>(loaded, "g", "names") == Texts{"p=q"});
  CHECK(loaded.parameters[0].overridden);
  CHECK(std::get<int64_t>(*loaded.parameters[0].value) == 8);
}

TEST_CASE("a parameter's value from the command line is taken as it is") {
  const std::string parameters = R"("t": {"type": "text", "default": ""})";
  CHECK(adjusted<std::string>("label", "\"$t\"", {"t=@x $y $$"}, parameters) == "@x $y $$");
  CHECK(adjusted<std::string>("label", "\"$t\"", {"t="}, parameters) == "");
  CHECK(adjusted<std::string>("label", "\"$t\"", {"t=a=b"}, parameters) == "a=b");
}

TEST_CASE("numbers on the command line may leave out the zero beside the point and may have a plus sign") {
  for (const auto& [written, meant] : {std::pair(".07", 0.07), {"+.5", 0.5}, {"1.", 1.0}, {"+1", 1.0}, {".5e0", 0.5}})
    CHECK(adjusted<double>("amount", "0", {fmt::format("b.amount={}", written)}) == meant);
  CHECK(adjusted<double>("low", "0", {"b.low=-.25"}) == -0.25);
  CHECK(adjusted<int64_t>("steps", "1", {"b.steps=+7"}) == 7);
  CHECK(adjusted<std::string>("label", "\"\"", {"b.label=.07"}) == ".07");
  for (const std::string wrong : {".", "-.", "+-1", "++1", "1..", ".x", "0x1", "+"})
    CHECK_THROWS_AS(adjusted<double>("amount", "0", {"b.amount=" + wrong}), GraphError);
}

TEST_CASE("an override mends what is wrong in the document") {
  const std::string text = document(R"("a": {"type": "photo", "file": 3}, "b": {"type": "adjust", "amount": 7})");
  CHECK(problems_of(text, {"a.file=x.png", "b.amount=0.5", "b.image=@a"}) == "");
}

TEST_CASE("nodes come after those they read, otherwise as in the document") {
  const LoadedGraph loaded = load_fake(document(
      R"("d": {"type": "adjust", "image": "@c", "mask": "@b"}, "x": {"type": "photo", "file": "x"},
         "c": {"type": "adjust", "image": "@a"}, "b": {"type": "adjust", "image": "@x"}, )" +
      photo_a));
  CHECK(order_of(loaded.graph) == std::vector<std::string>{"a", "c", "x", "b", "d"});
}

TEST_CASE("two cycles that share a node are both found") {
  const std::string problems = problems_of(document(
      R"("a": {"type": "adjust", "image": "@b", "mask": "@c"}, "b": {"type": "adjust", "image": "@a"},
         "c": {"type": "adjust", "image": "@a"})"));
  CHECK(problems.find("the wires form a cycle: a -> b -> a") != std::string::npos);
  CHECK(problems.find("the wires form a cycle: a -> c -> a") != std::string::npos);
}

TEST_CASE("an image that becomes a material is shown") {
  const LoadedGraph loaded =
      load_fake(document(photo_a + R"(, "out": {"type": "write", "material": "@a", "path": "o"})"));
  REQUIRE(loaded.conversions.size() == 1);
  CHECK(describe("/project/graphs/test.json", loaded.conversions[0]) ==
        "/project/graphs/test.json:1:128: node \"out\", port \"material\": the image of \"@a\" becomes a material of "
        "one map");
}

TEST_CASE("what nothing uses is a warning") {
  const std::string sink = R"(, "out": {"type": "write", "material": "@a", "path": "o"})";
  const LoadedGraph loaded = load_fake(document(photo_a + R"(, "b": {"type": "adjust", "image": "@a"})" + sink,
                                                R"("seed": {"type": "int", "default": 1})"));
  REQUIRE(loaded.warnings.size() == 2);
  CHECK(describe("", loaded.warnings[0]).ends_with("parameter \"seed\": no node uses it"));
  CHECK(describe("", loaded.warnings[1]).ends_with("node \"b\": no sink reads it; it will not run"));
  const LoadedGraph idle = load_fake(document(photo_a));
  REQUIRE(idle.warnings.size() == 1);
  CHECK(describe("", idle.warnings[0]).ends_with("no node is a sink: a run writes nothing"));
}

TEST_CASE("a graph can be looked at before its parameters are set") {
  const std::string text =
      document(R"("a": {"type": "photo", "file": "$p/a.png"}, "b": {"type": "adjust", "image": "@a", "amount": 2})",
               R"("p": {"type": "path"})");
  CHECK(problems_of(text).find("--set p=VALUE") != std::string::npos);
  CHECK_THROWS_WITH_AS(load_graph_text(text, "t.json", {}, {.types = fake_types(), .allow_unset = true}),
                       doctest::Contains("amount"), GraphError);
  const LoadedGraph loaded =
      load_graph_text(text, "t.json", {override_of("b.amount", "1")}, {.types = fake_types(), .allow_unset = true});
  CHECK_FALSE(loaded.parameters[0].value);
  CHECK_FALSE(loaded.graph.find("a")->params.contains("file"));
  CHECK(loaded.graph.find("b")->inputs.at("image")[0].node == "a");
}

TEST_CASE("what only some nodes need is all that must be set for them") {
  const std::string text = document(R"("a": {"type": "photo", "file": "$p"}, "b": {"type": "adjust", "image": "@a"},
                                       "c": {"type": "photo", "file": "$q"})",
                                    R"("p": {"type": "path"}, "q": {"type": "path"}, "idle": {"type": "int"})");
  const auto load = [&](const std::vector<std::string>& set, const std::vector<std::string>& only) {
    return load_graph_text(text, "t.json", overrides_from(set), {.types = fake_types(), .only = only});
  };
  CHECK(order_of(load({"p=a.png"}, {"b"}).graph) == std::vector<std::string>{"a", "b"});
  CHECK(order_of(load({"p=a.png", "q=c.png"}, {"b"}).graph).size() == 3);
  const auto unset = [&](const std::vector<std::string>& only) {
    try {
      load({}, only);
    } catch (const GraphError& e) {
      return e.problems().size();
    }
    return size_t{0};
  };
  CHECK(unset({}) == 3);
  CHECK(unset({"b"}) == 1);
  CHECK(unset({"b", "c"}) == 3);
  CHECK(unset({"b", "none"}) == 3);
}

TEST_CASE("the interface of a graph is read without looking at its nodes") {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "g.json";
  std::ofstream(file) << R"({"terrazzo": 1, "summary": "S", "help": "H", "nodes": {"a": {"type": "not a type"}},
    "parameters": {"in": {"type": "path", "help": "a folder"}, "mode": {"type": "choice", "choices": ["a", "b"], "default": "b"}}})";
  const GraphInterface interface = read_interface(file);
  CHECK(interface.summary == "S");
  CHECK(interface.help == "H");
  REQUIRE(interface.parameters.size() == 2);
  CHECK(interface.parameters[0].param.type == ParamType::path);
  CHECK(interface.parameters[0].param.help == "a folder");
  CHECK_FALSE(interface.parameters[0].param.fallback);
  CHECK(std::get<std::string>(*interface.parameters[1].param.fallback) == "b");
  CHECK(interface.parameters[1].param.choices == std::vector<std::string>{"a", "b"});
}

TEST_CASE("a file that cannot be read is named, with the one that may have been meant") {
  const TemporaryFolder folder;
  std::ofstream(folder.path() / "material.json") << "{}";
  const std::string wrong = (folder.path() / "materiel.json").string();
  const std::string right = (folder.path() / "material.json").string();
  CHECK_THROWS_WITH_AS(load_graph(wrong), doctest::Contains(("did you mean \"" + right + "\"").c_str()), GraphError);
  CHECK_THROWS_WITH_AS(load_graph(folder.path()), doctest::Contains("found a folder"), GraphError);
  CHECK_THROWS_WITH_AS(load_graph(folder.path() / "x/y/z.json"), doctest::Contains("there is no such graph file"),
                       GraphError);
}

TEST_CASE("the problems of a document are there one by one, in the order of the file") {
  try {
    load_fake(document(R"("a": {"type": "adjust", "amount": 3, "image": "@z"}, "b": {"type": "foto"})"), {"x=1"});
    FAIL("no problem was found");
  } catch (const GraphError& e) {
    REQUIRE(e.problems().size() == 4);
    CHECK(e.problems()[0].where == "node \"a\", parameter \"amount\"");
    CHECK(e.problems()[1].where == "node \"a\", port \"image\"");
    CHECK(e.problems()[2].where == "node \"b\"");
    CHECK(e.problems()[3].where == "override \"x=1\"");
    CHECK(e.problems()[3].place.line == 0);
    CHECK(e.problems()[0].node == "a");
    CHECK(e.problems()[0].parameter == "amount");
    CHECK(!e.problems()[0].override_position);
    CHECK(e.problems()[1].parameter == "image");
    CHECK(e.problems()[3].parameter == "x");
    CHECK(e.problems()[3].override_position == 0);
  }
}

TEST_CASE("long chains of nodes are ordered, whichever way they are written") {
  constexpr int count = 2000;
  for (const bool backwards : {false, true}) {
    std::vector<std::string> entries = {photo_a};
    for (int i = 0; i < count; i++)
      entries.push_back(fmt::format(R"("n{}": {{"type": "adjust", "image": "@{}", "amount": 0.5}})", i,
                                    i == 0 ? "a" : fmt::format("n{}", i - 1)));
    if (backwards) std::reverse(entries.begin(), entries.end());
    const LoadedGraph loaded = load_fake(document(fmt::format("{}", fmt::join(entries, ",\n"))));
    REQUIRE(loaded.graph.nodes.size() == count + 1);
    CHECK(loaded.graph.nodes.front().name == "a");
    CHECK(loaded.graph.nodes.back().name == "n1999");
  }
}
