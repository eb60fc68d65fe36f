#include <doctest/doctest.h>
#include <fmt/format.h>

#include "tests/graphs/document/fake_types.h"
#include "tests/texts.h"

using namespace terrazzo;
using namespace terrazzo::test;

namespace {

const std::string photo_a = R"("a": {"type": "photo", "file": "maps/a.png"})";

std::string adjust(const std::string& entries) {
  return photo_a + fmt::format(R"(, "b": {{"type": "adjust", "image": "@a", {}}})", entries);
}

template <typename T>
T adjusted(const std::string& param, const std::string& json, const std::string& parameters,
           const std::vector<std::string>& overrides = {}) {
  const LoadedGraph loaded =
      load_fake(document(adjust(fmt::format(R"("{}": {})", param, json)), parameters), overrides);
  return std::get<T>(loaded.graph.find("b")->params.at(param));
}

const std::string size_and_count =
    R"("size": {"type": "size", "default": [512, 256]}, "count": {"type": "int", "default": 6})";

}  // namespace

TEST_CASE("a parameter takes the value of an expression") {
  CHECK(adjusted<Size>("size", R"("=size / 2")", size_and_count) == Size{256, 128});
  CHECK(adjusted<Size>("size", R"("=[size.x, count * 16]")", size_and_count) == Size{512, 96});
  CHECK(adjusted<Size>("size", R"(["=size.x / 4", 64])", size_and_count) == Size{128, 64});
  CHECK(adjusted<int64_t>("steps", R"("=count + 1")", size_and_count) == 7);
  CHECK(adjusted<double>("amount", R"("=count / 12")", size_and_count) == 0.5);
  CHECK(adjusted<bool>("wrap", R"("=count > 5")", size_and_count));
  CHECK(adjusted<std::string>("label", R"("=count > 5 ? 'many' : 'few'")", size_and_count) == "many");
  CHECK(adjusted<std::string>("label", R"("=count / 4")", size_and_count) == "1.5");
  CHECK(adjusted<std::string>("label", R"("==count")", size_and_count) == "=count");
  CHECK(adjusted<std::string>("label", R"("a=count")", size_and_count) == "a=count");
}

TEST_CASE("overrides and defaults may be expressions as well") {
  const std::string twice = R"("a": {"type": "int", "default": 4}, "b": {"type": "int", "default": "=a * 2"},)"
                            R"("c": {"type": "int", "default": "=b + 1"})";
  CHECK(adjusted<int64_t>("steps", R"("$c")", twice) == 9);
  CHECK(adjusted<int64_t>("steps", R"("=c * b")", twice) == 72);
  CHECK(adjusted<int64_t>("steps", R"("$c")", twice, {"a=1"}) == 3);
  CHECK(adjusted<int64_t>("steps", R"("$c")", twice, {"b=1"}) == 2);
  CHECK(adjusted<int64_t>("steps", R"("$c")", twice, {"b==a * a"}) == 17);
  CHECK(adjusted<int64_t>("steps", R"("$c")", twice, {"b.steps==a * 5"}) == 20);
}

TEST_CASE("a path that is made by an expression lies where it is written") {
  const std::string name = R"("name": {"type": "text", "default": "x"})";
  const LoadedGraph loaded =
      load_fake(document(R"("a": {"type": "photo", "file": "=name == 'x' ? 'one.png' : 'two.png'"})", name));
  CHECK(std::get<std::string>(loaded.graph.find("a")->params.at("file")) == "/project/graphs/one.png");
}

TEST_CASE("what is wrong in an expression is said with its column") {
  const auto problem = [](const std::string& entry, const std::string& parameters = size_and_count) {
    return problems_of(document(adjust(entry), parameters));
  };
  CHECK(problem(R"("steps": "=cuont + 1")").find("\"cuont\" (did you mean \"count\"?)") != std::string::npos);
  CHECK(problem(R"("steps": "=count / 4")") ==
        "test.json:1:226: node \"b\", parameter \"steps\": expected an integer of at least 1, found the number 1.5 "
        "(from \"=count / 4\")");
  CHECK(problem(R"("steps": "=count +")")
            .find(": expected a number, a name, 'text' or (, found the end, in "
                  "\"=count +\"") != std::string::npos);
  CHECK(problem(R"("size": "$size/2")").find("to compute with it, write \"=size/2\"") != std::string::npos);
  // The place is that of the name inside the text.
  const std::string at_start = problem(R"("steps": "=wrong")"), further = problem(R"("steps": "=    wrong")");
  const auto column = [](const std::string& message) { return std::stoi(message.substr(message.find(":1:") + 3)); };
  CHECK(column(further) == column(at_start) + 4);
}

TEST_CASE("values that are made from themselves are refused") {
  const auto problem = [](const std::string& parameters) {
    return problems_of(document(adjust(R"("steps": "$a")"), parameters));
  };
  CHECK(problem(R"("a": {"type": "int", "default": "=b"}, "b": {"type": "int", "default": "=a"})")
            .find("its value depends on itself: a -> b -> a") != std::string::npos);
  CHECK(problem(R"("a": {"type": "int", "default": "=a + 1"})").find("on itself: a -> a") != std::string::npos);
  const auto link = [](int i) { return fmt::format(R"("a{}": {{"type": "int", "default": "=a{} + 1"}}, )", i, i - 1); };
  std::string forth, back;
  for (int i = 1; i < 5000; i++) {
    forth += link(i);
    back = link(i) + back;
  }
  for (const std::string& chain : {forth, back}) {
    const std::string all = chain + R"("a0": {"type": "int", "default": 1}, "a": {"type": "int", "default": "=a4999"})";
    CHECK(problem(all).find("depends on a chain of more than 100 others") != std::string::npos);
  }
}

TEST_CASE("an expression of a parameter that is not set asks for that parameter") {
  const std::string parameters = R"("a": {"type": "int"}, "b": {"type": "int", "default": "=a * 2"})";
  const std::string text = document(adjust(R"("steps": "=b + 1")"), parameters);
  CHECK(problems_of(text).find("parameter \"a\": has no default and must be set: --set a=VALUE") != std::string::npos);
  CHECK(problems_of(text).find("parameter \"b\"") == std::string::npos);
  CHECK(problems_of(text, {"a=2"}).empty());
}

TEST_CASE("units are checked where both sides name one") {
  const std::string degrees = R"("turn": {"type": "number", "default": 90, "unit": "degrees"})";
  CHECK(problems_of(document(adjust(R"("size": "=[turn, turn]")"), degrees))
            .find("expected pixels, found a value in degrees") != std::string::npos);
  CHECK(problems_of(document(adjust(R"("amount": "=turn / 180")"), degrees)).empty());
}

TEST_CASE("a parameter that only another one uses is used") {
  const std::string parameters = R"("a": {"type": "int", "default": 2}, "b": {"type": "int", "default": "=a * 2"},)"
                                 R"("c": {"type": "int", "default": 3})";
  const LoadedGraph loaded = load_fake(document(
      adjust(R"("steps": "=b")") +
          R"(, "w": {"type": "gather", "images": "@b"}, "f": {"type": "write", "material": "@w", "path": "x"})",
      parameters));
  REQUIRE(loaded.warnings.size() == 1);
  CHECK(describe("", loaded.warnings.front()).find("parameter \"c\": no node uses it") != std::string::npos);
}

TEST_CASE("sizes of sources are known to expressions before anything runs") {
  const auto load = [](const std::string& nodes, const std::string& parameters,
                       const std::vector<std::string>& overrides = {}) {
    return load_graph_text(document(nodes, parameters), "/project/test.json", overrides_from(overrides));
  };
  const std::string twice = R"("size": {"type": "size", "default": "=@stones.size * 2"})";
  const std::string nodes = R"("far": {"type": "noise", "size": "$size"},)"
                            R"("mean": {"type": "noise", "size": "=@far.size / 4 + [0, @stones.count]"},)"
                            R"("stones": {"type": "pattern", "kind": "gravel", "size": [96, 64]})";
  const LoadedGraph loaded = load(nodes, twice);
  const auto size_of = [](const LoadedGraph& graph, const std::string& node) {
    return std::get<Size>(graph.graph.find(node)->params.at("size"));
  };
  CHECK(size_of(loaded, "far") == Size{192, 128});
  CHECK(size_of(loaded, "mean") == Size{48, 37});
  CHECK(std::get<Size>(*loaded.parameters.front().value) == Size{192, 128});
  CHECK(size_of(load(nodes, twice, {"stones.size=32"}), "far") == Size{64, 64});
  CHECK(size_of(load(nodes, twice, {"size=100"}), "far") == Size{100, 100});
  CHECK(size_of(load(nodes, twice, {"far.size==@stones.size.x"}), "far") == Size{96, 96});
}

TEST_CASE("texts and lists that are made from one another stay short") {
  std::string doubling = R"("t0": {"type": "text", "default": "0123456789"})";
  for (int i = 1; i <= 60; i++)
    doubling += fmt::format(R"(, "t{0}": {{"type": "text", "default": "=t{1} + t{1}"}})", i, i - 1);
  CHECK(contains(problems_of(document(R"("a": {"type": "photo", "file": "$t60"})", doubling)),
                 "the result is longer than 1 MiB"));
  const std::string half(700000, 'x');
  const std::string text = R"("t": {"type": "text", "default": ")" + half + R"("})";
  CHECK(problems_of(document(R"("a": {"type": "photo", "file": "$t"})", text)) == "");
  for (const char* value : {R"("$t$t")", R"("=t + t")"})
    CHECK(contains(problems_of(document(fmt::format(R"("a": {{"type": "photo", "file": {}}})", value), text)),
                   "longer than 1 MiB"));
  CHECK(contains(problems_of(document(R"("g": {"type": "gather", "images": "@a", "channels": {"r": "$t", "g": "$t"}},
    "a": {"type": "photo", "file": "x"})",
                                      text)),
                 "longer than 1 MiB"));
  CHECK(
      contains(problems_of(document(R"("a": {"type": "photo", "file": "$t", "foreach": {"values": "1..200"}})", text)),
               "are longer than 64 MiB"));
}

TEST_CASE("an expression cannot ask for what is made from it, nor for what is not known") {
  const auto problem = [](const std::string& nodes) {
    return problems_of(document(nodes)) + [&] {
      try {
        load_graph_text(document(nodes), "test.json");
        return std::string();
      } catch (const GraphError& e) {
        return std::string(e.what());
      }
    }();
  };
  CHECK(problem(R"("a": {"type": "noise", "size": "=@b.size"}, "b": {"type": "noise", "size": "=@a.size"})")
            .find("form a cycle: a -> b -> a") != std::string::npos);
  CHECK(problem(R"("a": {"type": "noise", "size": 64}, "b": {"type": "blur", "image": "@a", "radius": "=@b.size.x"})")
            .find("cycle") != std::string::npos);
  CHECK(problem(R"("a": {"type": "noise", "size": 64}, "b": {"type": "grayscale", "image": "@a"},)"
                R"("c": {"type": "noise", "size": "=@b.size"})")
            .find("is not known before it runs") == std::string::npos);
  CHECK(problem(R"("a": {"type": "pattern", "size": 64}, "w": {"type": "weight", "material": "@a"},)"
                R"("s": {"type": "pca", "features": "@w"}, "i": {"type": "index", "appearance": "@s"},)"
                R"("b": {"type": "make_tileable", "index": "@i"}, "c": {"type": "noise", "size": "=@b.size"})")
            .find("the size of the result of \"b\" is not known before it runs") != std::string::npos);
  CHECK(problem(R"("a": {"type": "noise", "size": "=@wrong.size"})").find("@wrong leads to no node") !=
        std::string::npos);
  CHECK(problem(R"("a": {"type": "load_map", "path": "missing.png"}, "b": {"type": "noise", "size": "=@a.size"})")
            .find("missing.png") != std::string::npos);
}

TEST_CASE("sources that nothing of what runs needs may be missing, also where sizes are computed from them") {
  const std::string text = R"({"terrazzo": 1, "nodes": {
    "gone":  {"type": "load_map", "path": "missing.png"},
    "other": {"type": "noise", "size": "=@gone.size"},
    "a":     {"type": "noise", "size": 64},
    "b":     {"type": "noise", "size": "=@a.size / 2"}}})";
  const auto problem = [&](const std::vector<std::string>& only) {
    try {
      load_graph_text(text, "t.json", {}, {.only = only});
      return std::string();
    } catch (const GraphError& e) {
      return std::string(e.what());
    }
  };
  const LoadedGraph part = load_graph_text(text, "t.json", {}, {.only = {"b"}});
  REQUIRE(part.graph.nodes.size() == 1);
  CHECK(part.graph.nodes.front().name == "b");
  for (const std::vector<std::string>& only : std::vector<std::vector<std::string>>{{}, {"other"}, {"b", "gone"}})
    CHECK(problem(only).find("missing.png") != std::string::npos);
}

TEST_CASE("nodes derive their seeds from the graph's and their names, whatever their order") {
  const auto seed_of = [](const std::string& node, const std::string& nodes, const std::string& seed,
                          const std::vector<std::string>& overrides = {}) {
    const std::string text = R"({"terrazzo": 1, "parameters": {"s": {"type": "int", "default": 5}}, )" + seed +
                             R"("nodes": {)" + nodes + "}}";
    const LoadedGraph loaded = load_graph_text(text, "/project/test.json", overrides_from(overrides));
    return std::get<int64_t>(loaded.graph.find(node)->params.at("seed"));
  };
  const std::string a = R"("a": {"type": "noise", "size": 64})", b = R"("b": {"type": "noise", "size": 64})";
  const std::string pinned = R"("b": {"type": "noise", "size": 64, "seed": 3})";
  const std::string graph_seed = R"("seed": "$s", )";
  const int64_t usual = std::get<int64_t>(*find_node_type("noise")->find_param("seed")->fallback);
  CHECK(seed_of("a", a + "," + b, "") == usual);
  const int64_t of_a = seed_of("a", a + "," + b, graph_seed);
  CHECK(of_a != usual);
  CHECK(of_a != seed_of("b", a + "," + b, graph_seed));
  CHECK(of_a == seed_of("a", b + "," + a, graph_seed));
  CHECK(of_a == seed_of("a", a, R"("seed": 5, )"));
  CHECK(of_a == seed_of("a", a, R"("seed": "=s", )"));
  CHECK(of_a != seed_of("a", a, graph_seed, {"s=6"}));
  CHECK(seed_of("b", a + "," + pinned, graph_seed) == 3);
  CHECK(seed_of("b", a + "," + b, graph_seed, {"b.seed=9"}) == 9);
  CHECK_THROWS_WITH(seed_of("a", a, R"("seed": -1, )"),
                    "/project/test.json:1:77: \"seed\": expected an integer of at least 0, found the number -1");
}

TEST_CASE("one member of a map can be set by itself") {
  const std::string node = R"("s": {"type": "gather", "images": ["@a"], "gains": {"x": 2, "y": 3}})";
  const auto gains = [&](const std::string& nodes, const std::string& parameters,
                         const std::vector<std::string>& overrides) {
    const LoadedGraph loaded = load_fake(document(photo_a + ", " + nodes, parameters), overrides);
    return std::get<NumberMap>(loaded.graph.find("s")->params.at("gains"));
  };
  CHECK(gains(node, "", {"s.gains.x=5"}) == NumberMap{{"x", {5}}, {"y", {3}}});
  CHECK(gains(node, "", {"s.gains.x=5", "s.gains.z=[1, 2]"}) == NumberMap{{"x", {5}}, {"y", {3}}, {"z", {1, 2}}});
  CHECK(gains(node, "", {R"(s.gains={"x": 1})", "s.gains.y==1 + 1"}) == NumberMap{{"x", {1}}, {"y", {2}}});
  CHECK(gains(R"("s": {"type": "gather", "images": ["@a"]})", "", {"s.gains.x=5"}) == NumberMap{{"x", {5}}});
  const std::string map = R"("m": {"type": "number_map", "default": {"x": 7}})";
  const std::string of_graph = R"("s": {"type": "gather", "images": ["@a"], "gains": "$m"})";
  CHECK(gains(of_graph, map, {"m.y=4"}) == NumberMap{{"x", {7}}, {"y", {4}}});
  CHECK(gains(of_graph, map, {R"(m={"z": 1})", "m.z=3"}) == NumberMap{{"z", {3}}});
  const std::string text = document(photo_a + ", " + of_graph, map);
  CHECK(problems_of(text, {"s.gains.y=4"}).find("the value is the text \"$m\", of which no single member can be set") !=
        std::string::npos);
  CHECK(problems_of(text, {"n.y=4"}).find("the graph has no node \"n\"") != std::string::npos);
  CHECK_FALSE(problems_of(text, {"m.y=word"}).empty());
}

TEST_CASE("a message quotes the beginning of a long expression") {
  std::string sum = "=1";
  for (int i = 0; i < 30000; i++) sum += "+1";
  const std::string said = problems_of(document(adjust(R"("amount": ")" + sum + "\"")));
  CHECK(said.find("expected an expression of at most 10000 bytes") != std::string::npos);
  CHECK(said.find("and so on") != std::string::npos);
  CHECK(said.size() < 1000);
}
