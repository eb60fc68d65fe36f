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

const std::string twice = R"("twice": {
  "inputs": {"image": {"type": "image"}, "mask": {"type": "image", "optional": true}},
  "parameters": {"amount": {"type": "number", "default": 0.25}, "steps": {"type": "int", "default": "=amount > 0.5 ? 9 : 2"}},
  "nodes": {
    "first": {"type": "adjust", "image": "@image", "mask": "@mask", "amount": "$amount", "steps": "$steps"},
    "second": {"type": "adjust", "image": "@first", "label": "twice $amount"}
  },
  "outputs": {"image": "@second", "half": {"from": "@first", "help": "after one"}}
})";

std::string with_graphs(const std::string& graphs, const std::string& nodes, const std::string& parameters = "") {
  return fmt::format(R"({{"terrazzo": 1, "parameters": {{{}}}, "graphs": {{{}}}, "nodes": {{{}}}}})", parameters,
                     graphs, nodes);
}

std::string with_twice(const std::string& nodes, const std::string& parameters = "") {
  return with_graphs(twice, R"("a": {"type": "photo", "file": "a.png"}, )" + nodes, parameters);
}

const std::string written = R"(, "out": {"type": "write", "material": "@b", "path": "x.png"})";

const GraphNode& node_of(const LoadedGraph& loaded, const std::string& name) {
  const GraphNode* found = loaded.graph.find(name);
  REQUIRE_MESSAGE(found, name);
  return *found;
}

Wire wire_into(const LoadedGraph& loaded, const std::string& node, const std::string& port) {
  const auto& inputs = node_of(loaded, node).inputs;
  REQUIRE_MESSAGE(inputs.contains(port), node << "." << port);
  REQUIRE(inputs.at(port).size() == 1);
  return inputs.at(port).front();
}

std::vector<std::string> names_of(const LoadedGraph& loaded) {
  std::vector<std::string> out;
  for (const GraphNode& n : loaded.graph.nodes) out.push_back(n.name);
  return out;
}

}  // namespace

TEST_CASE("a subgraph's nodes stand in the graph under its node's name, wired through inputs and outputs") {
  const LoadedGraph loaded =
      load_fake(with_twice(R"("b": {"type": "twice", "image": "@a", "amount": 0.75})" + written));
  CHECK(names_of(loaded) == std::vector<std::string>{"a", "b/first", "b/second", "out"});
  CHECK(wire_into(loaded, "b/first", "image") == Wire{"a", "image"});
  CHECK(wire_into(loaded, "b/second", "image") == Wire{"b/first", "image"});
  CHECK(wire_into(loaded, "out", "material") == Wire{"b/second", "image"});
  CHECK_FALSE(node_of(loaded, "b/first").inputs.contains("mask"));
  CHECK(std::get<double>(node_of(loaded, "b/first").params.at("amount")) == 0.75);
  CHECK(std::get<int64_t>(node_of(loaded, "b/first").params.at("steps")) == 9);
  CHECK(std::get<std::string>(node_of(loaded, "b/second").params.at("label")) == "twice 0.75");
  CHECK(loaded.warnings.empty());
}

TEST_CASE("each use of a subgraph has values of its own; outputs have names") {
  const LoadedGraph loaded = load_fake(with_twice(
      R"("b": {"type": "twice", "image": "@a"}, "c": {"type": "twice", "image": "@b.half", "mask": "@a", "steps": "$n"})" +
          written,
      R"("n": {"type": "int", "default": 7})"));
  CHECK(wire_into(loaded, "c/first", "image") == Wire{"b/first", "image"});
  CHECK(wire_into(loaded, "c/first", "mask") == Wire{"a", "image"});
  CHECK(std::get<int64_t>(node_of(loaded, "b/first").params.at("steps")) == 2);
  CHECK(std::get<int64_t>(node_of(loaded, "c/first").params.at("steps")) == 7);
}

TEST_CASE("subgraphs nest, and overrides reach every level") {
  const std::string four = R"(, "four": {"inputs": {"image": {"type": "image"}},
    "nodes": {"one": {"type": "twice", "image": "@image"}, "other": {"type": "twice", "image": "@one"}},
    "outputs": {"image": "@other"}})";
  const std::string text = with_graphs(
      twice + four, R"("a": {"type": "photo", "file": "a.png"}, "b": {"type": "four", "image": "@a"})" + written);
  const LoadedGraph loaded =
      load_fake(text, {"b/other.amount=1", "b/one/second.wrap=true", "b/other/first.low=-1", "b/one.mute=true"});
  CHECK(names_of(loaded) == std::vector<std::string>{"a", "b/other/first", "b/other/second", "out"});
  CHECK(wire_into(loaded, "b/other/first", "image") == Wire{"a", "image"});
  CHECK(std::get<double>(node_of(loaded, "b/other/first").params.at("amount")) == 1);
  CHECK(std::get<double>(node_of(loaded, "b/other/first").params.at("low")) == -1);
  CHECK(problems_of(text, {"b/othr.amount=1", "b/other/first/x.low=1", "b/other.amont=1"}) ==
        "test.json: override \"b/other.amont=1\": twice has no port or parameter \"amont\" (did you mean \"amount\"?)\n"
        "test.json: override \"b/other/first/x.low=1\": \"first\" is not a graph with nodes\n"
        "test.json: override \"b/othr.amount=1\": \"b\" has no node \"othr\" (did you mean \"other\"?)");
}

TEST_CASE("a file is a subgraph, with its own folder and places of its own") {
  const TemporaryFolder folder;
  fs::create_directories(folder.path() / "parts");
  write_text(folder.path() / "parts/blur.json", R"({"terrazzo": 1, "inputs": {"image": {"type": "image"}},
 "parameters": {"config": {"type": "path", "default": "blur.cfg"}, "amount": {"type": "number", "default": 1}},
 "nodes": {"n": {"type": "adjust", "image": "@image", "amount": "$amount", "config": "$config"},
           "p": {"type": "photo", "file": "inner.png"}},
 "outputs": {"image": "@n"}})");
  const std::string nodes =
      R"("a": {"type": "photo", "file": "a.png"}, "b": {"type": "parts/blur.json", "image": "@a")";
  const std::string path = (folder.path() / "main.json").string();
  const LoadedGraph loaded = load_fake(document(nodes + "}" + written), {}, path);
  CHECK(std::get<std::string>(node_of(loaded, "b/p").params.at("file")) == folder.path() / "parts/inner.png");
  CHECK(std::get<std::string>(node_of(loaded, "b/n").params.at("config")) == folder.path() / "parts/blur.cfg");
  CHECK(loaded.graph.made_from == std::vector<fs::path>{folder.path() / "parts/blur.json"});

  CHECK(problems_of(document(nodes + R"(, "amount": 2})" + written), {}, path) ==
        fmt::format(
            "{}/parts/blur.json:3:65: node \"b/n\", parameter \"amount\": expected a number from 0 to 1, found the "
            "number 2 (from \"$amount\")",
            folder.path().string()));
  CHECK(problems_of(document(R"("b": {"type": "parts/blr.json"})"), {}, path) ==
        fmt::format("{}:1:59: node \"b\": the graph \"parts/blr.json\": there is no such graph file (did you mean "
                    "\"{}/parts/blur.json\"?)",
                    path, folder.path().string()));
}

TEST_CASE("a graph that is part of itself is refused with the way through it") {
  const std::string ring =
      R"("x": {"inputs": {"image": {"type": "image"}}, "nodes": {"n": {"type": "y", "image": "@image"}},
    "outputs": {"image": "@n"}}, "y": {"inputs": {"image": {"type": "image"}}, "nodes": {"m": {"type": "x", "image": "@image"}},
    "outputs": {"image": "@m"}})";
  const std::string problems = problems_of(
      with_graphs(ring, R"("a": {"type": "photo", "file": "a.png"}, "b": {"type": "x", "image": "@a"})" + written));
  CHECK(problems.find("node \"b/n/m\": the graph is part of itself: x -> y -> x") != problems.npos);
}

TEST_CASE("small files that would make endless graphs are refused") {
  std::string graphs = R"("g0": {"nodes": {"p": {"type": "photo", "file": "x.png"}}, "outputs": {"image": "@p"}})";
  for (int i = 1; i <= 20; i++) {
    std::string nodes;
    for (int k = 0; k < 10; k++) nodes += fmt::format(R"({}"n{}": {{"type": "g{}"}})", k ? ", " : "", k, i - 1);
    graphs += fmt::format(R"(, "g{}": {{"nodes": {{{}}}, "outputs": {{"image": "@n0"}}}})", i, nodes);
  }
  const std::string problems = problems_of(with_graphs(graphs, R"("b": {"type": "g20"})" + written));
  CHECK(problems.find("a graph may have at most 100000 nodes") != problems.npos);
}

TEST_CASE("inputs that lead back to themselves are a cycle") {
  const std::string loop =
      R"("pass": {"inputs": {"image": {"type": "image"}}, "nodes": {}, "outputs": {"image": "@image"}})";
  CHECK(problems_of(with_graphs(
            loop, R"("a": {"type": "pass", "image": "@a"}, "b": {"type": "adjust", "image": "@a"})" + written)) ==
        "test.json:1:183: node \"b\", port \"image\": the wires of subgraphs form a cycle");
}

TEST_CASE("what is wrong about a subgraph is said where it stands") {
  CHECK(problems_of(with_twice(R"("b": {"type": "twice", "image": "@a.file", "amout": 1})" + written))
            .find("node \"b\": twice has no port or parameter \"amout\" (did you mean \"amount\"?)") !=
        std::string::npos);
  CHECK(problems_of(with_twice(R"("b": {"type": "twice"})" + written))
            .ends_with("node \"b\": the port \"image\" must be given: expected a wire of type image"));
  CHECK(problems_of(with_twice(R"("b": {"type": "twic", "image": "@a"})" + written))
            .find("unknown node type \"twic\" (did you mean \"twice\"?)") != std::string::npos);
  CHECK(problems_of(
            with_twice(
                R"("b": {"type": "twice", "image": "@a"}, "w": {"type": "write", "material": "@b.full", "path": "y"})" +
                written))
            .ends_with("node \"w\", port \"material\": twice has no output \"full\" (valid: \"image\" or \"half\")"));
  CHECK(problems_of(with_graphs(R"("photo": {"nodes": {}})", R"("b": {"type": "photo", "file": "x"})" + written))
            .find("graph \"photo\": a node type has this name") != std::string::npos);
  CHECK(problems_of(with_graphs(R"("g": {"inputs": {"i": {"type": "picture"}}, "node": {}})", R"("b": {"type": "g"})"))
            .find("expected a type of values (\"image\", \"material\"") != std::string::npos);
  CHECK(problems_of(with_graphs(R"("g": {"nodes": {}, "nods": {}})", R"("b": {"type": "g"})"))
            .find("graph \"g\": unknown key \"nods\" (did you mean \"nodes\"?)") != std::string::npos);
}

TEST_CASE(
    "a wire of the wrong type into an input is refused, and one that the input's type does not allow further on") {
  const std::string g =
      R"("g": {"inputs": {"m": {"type": "material"}}, "nodes": {"x": {"type": "adjust", "image": "@m"}}, "outputs": {"image": "@x"}})";
  const std::string text =
      with_graphs(g, R"("a": {"type": "photo", "file": "x"}, "b": {"type": "g", "m": "@a"})" + written);
  CHECK(problems_of(text).find("node \"b/x\", port \"image\": expected a wire of type image, found \"@m\", which is of "
                               "type material") != std::string::npos);
}

TEST_CASE("a graph with inputs can be checked by itself, and run only as a node") {
  const std::string text = R"({"terrazzo": 1, "inputs": {"m": {"type": "material"}}, "nodes": {
    "w": {"type": "write", "material": "@m", "path": "x.png"}}})";
  CHECK(
      problems_of(text).ends_with("input \"m\": it is not connected: a graph with inputs runs as a node of another "
                                  "graph"));
  const LoadedGraph loaded = load_graph_text(text, "/p/t.json", {}, {.types = fake_types(), .allow_unset = true});
  REQUIRE(loaded.graph.nodes.size() == 1);
  CHECK(loaded.graph.nodes.front().is_open);
}

TEST_CASE("an expression chooses a wire, and the outputs of a graph") {
  const std::string nodes =
      R"("a": {"type": "photo", "file": "a.png"}, "c": {"type": "photo", "file": "c.png"},
         "b": {"type": "adjust", "image": "=late ? '@c' : '@a'", "mask": "=late ? '' : '@c'"})" +
      written;
  const std::string parameters = R"("late": {"type": "bool", "default": false})";
  CHECK(wire_into(load_fake(document(nodes, parameters)), "b", "image").node == "a");
  const LoadedGraph late = load_fake(document(nodes, parameters), {"late=true"});
  CHECK(wire_into(late, "b", "image").node == "c");
  CHECK_FALSE(node_of(late, "b").inputs.contains("mask"));
  CHECK(late.warnings.empty());
  const std::string pick = R"("pick": {"inputs": {"x": {"type": "image"}, "y": {"type": "image"}},
    "parameters": {"which": {"type": "choice", "choices": ["x", "y"], "default": "x"}},
    "nodes": {}, "outputs": {"image": {"from": "='@' + which", "type": "image"}}})";
  const std::string uses = R"("a": {"type": "photo", "file": "a.png"}, "c": {"type": "photo", "file": "c.png"},
    "b": {"type": "pick", "x": "@a", "y": "@c", "which": "y"})";
  CHECK(wire_into(load_fake(with_graphs(pick, uses + written)), "out", "material").node == "c");
}

TEST_CASE("a muted node does not run, and what comes into it passes") {
  const std::string nodes =
      R"("a": {"type": "photo", "file": "a.png"}, "b": {"type": "adjust", "image": "@a", "mute": "=off", "comment": "why"})";
  const std::string off = R"("off": {"type": "bool", "default": true})";
  const LoadedGraph muted = load_fake(document(nodes + written, off));
  CHECK(names_of(muted) == std::vector<std::string>{"a", "out"});
  CHECK(wire_into(muted, "out", "material") == Wire{"a", "image"});
  CHECK(node_of(load_fake(document(nodes + written, off), {"off=false"}), "b").comment == "why");
  CHECK(names_of(load_fake(document(nodes + written, off), {"out.mute=true", "b.mute=false"})) ==
        std::vector<std::string>{"a", "b"});
  CHECK(problems_of(document(R"("b": {"type": "photo", "file": "a.png", "mute": true})" + written))
            .ends_with(
                "node \"out\", port \"material\": the node \"b\" is muted, and has no connected input of type image "
                "to pass through"));
}

TEST_CASE("seeds come from the path, so that two uses of a subgraph have different ones") {
  std::vector<NodeType> types = fake_types();
  types[1].params.push_back({.name = "seed", .type = ParamType::integer, .fallback = int64_t{1}});
  const std::string text = R"({"terrazzo": 1, "seed": 5, "graphs": {"g": {"inputs": {"image": {"type": "image"}},
    "nodes": {"n": {"type": "adjust", "image": "@image"}}, "outputs": {"image": "@n"}}},
    "nodes": {"a": {"type": "photo", "file": "x"}, "b": {"type": "g", "image": "@a"}, "c": {"type": "g", "image": "@b"},
    "out": {"type": "write", "material": "@c", "path": "x.png"}}})";
  const LoadedGraph loaded = load_graph_text(text, "/p/t.json", {}, {.types = types});
  const auto seed = [&](const std::string& node) { return std::get<int64_t>(node_of(loaded, node).params.at("seed")); };
  CHECK(seed("b/n") != seed("c/n"));
  CHECK(seed("b/n") != 1);
}

TEST_CASE("a graph that nothing uses is a warning") {
  const LoadedGraph loaded = load_fake(with_twice(R"("b": {"type": "adjust", "image": "@a"})" + written));
  REQUIRE(loaded.warnings.size() == 1);
  CHECK(describe("", loaded.warnings.front()).ends_with("graph \"twice\": no node is of this type"));
}
