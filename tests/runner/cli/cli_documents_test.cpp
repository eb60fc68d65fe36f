#include <filesystem>

#include <doctest/doctest.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/image_io/image_file.h"
#include "test_paths.h"
#include "tests/runner/program.h"
#include "tests/runner/workplace.h"
#include "tests/texts.h"

using namespace terrazzo;
using namespace terrazzo::test;

namespace fs = std::filesystem;
using nlohmann::json;

TEST_CASE("check tells programs what is wrong and where, in JSON") {
  const Workplace w;
  write_text(w.path / "bad.json", R"({"terrazzo": 1, "nodes": {
 "n": {"type": "load_map", "path": "photo.png"},
 "b/c": {"type": "blur", "image": "@m", "radius": -1},
 "f": {"type": "export", "material": "@n", "path": "x.png", "maps": ["base_color", 3]}}})");
  const ProgramRun run = w.run({"check", "bad.json", "--json"});
  CHECK(run.code == 2);
  const json out = json::parse(run.out);
  CHECK_FALSE(out["valid"]);
  std::vector<std::string> found;
  for (const json& p : out["problems"])
    found.push_back(p["code"].get<std::string>() + " " + p["pointer"].get<std::string>());
  CHECK(found == std::vector<std::string>{"node /nodes/b~1c", "wire /nodes/b~1c/image", "parameter /nodes/b~1c/radius",
                                          "parameter /nodes/f/maps/1"});
  const json good = json::parse(w.run({"check", "soft.json", "--json"}).out);
  CHECK(good["valid"]);
  CHECK(good["problems"].back()["code"] == "conversion");
}

TEST_CASE("a problem with a member of a map, or an item of a list, points at it") {
  const Workplace w;
  write_text(w.path / "maps.json", R"({"terrazzo": 1, "nodes": {
 "p": {"type": "pattern", "kind": "gravel", "size": 64},
 "w": {"type": "weight", "material": "@p", "weights": {
   "height": 1,
   "normals": 2,
   "rust": 3}},
 "s": {"type": "pca", "features": "@w"}, "i": {"type": "index", "appearance": "@s"},
 "a": {"type": "save_analysis", "index": "@i", "path": "a.tza"},
 "f": {"type": "export", "material": "@p", "path": "out/{map}.png", "maps": ["height",
   "rust"]}}})");
  const auto pointers = [&](const std::vector<std::string>& more) {
    std::vector<std::string> args = {"check", "maps.json", "--json"}, found;
    args.insert(args.end(), more.begin(), more.end());
    const json report = json::parse(w.run(args).out);
    for (const json& p : report["problems"])
      found.push_back(fmt::format("{}:{}", p["line"].get<int>(), p["pointer"].get<std::string>()));
    return found;
  };
  CHECK(pointers({}) ==
        std::vector<std::string>{"5:/nodes/w/weights/normals", "6:/nodes/w/weights/rust", "10:/nodes/f/maps/1"});
  CHECK(contains(w.run({"check", "maps.json"}).err,
                 "maps.json:5:4: node \"w\" (weight), parameter \"weights\": there is no map \"normals\" (did you mean "
                 "\"normal\"?)"));
  // The value of the command line stands in no file.
  CHECK(pointers({"--set", "w.weights.moss=1"}) ==
        std::vector<std::string>{"3:/nodes/w", "3:/nodes/w", "3:/nodes/w", "10:/nodes/f/maps/1"});
}

TEST_CASE("a mistake in several iterations of a loop names them all") {
  const Workplace w;
  write_text(w.path / "loop.json",
             R"({"terrazzo": 1, "graphs": {"one": {"parameters": {"n": {"type": "int"}}, "nodes": {
 "p": {"type": "pattern", "kind": "gravel", "size": 64, "seed": "$n"},
 "w": {"type": "weight", "material": "@p", "weights": {"nonsense": 1}}, "s": {"type": "pca", "features": "@w"},
 "i": {"type": "index", "appearance": "@s"}, "a": {"type": "save_analysis", "index": "@i", "path": "a.tza"}}}},
 "nodes": {"all": {"type": "one", "foreach": {"values": [1, 2, 3]}, "n": "$item"}}})");
  const ProgramRun run = w.run({"check", "loop.json"});
  CHECK(run.code == 2);
  CHECK(contains(run.err, "the same in all[2] and all[3]"));
  CHECK(contains(run.err, "let the path tell the iterations of the loop apart"));
}

TEST_CASE("a parameter of the graph that is taken for an option is told how to be set") {
  const Workplace w;
  for (const char* arg : {"--radius", "--radius=2"}) {
    const ProgramRun run = w.run({"run", "soft.json", arg});
    CHECK(run.code == 2);
    CHECK(contains(run.err, "--set radius=VALUE sets the graph's parameter radius"));
  }
  CHECK(contains(w.run({"run", "soft.json", "--swep", "radius=1"}).err, "did you mean \"--sweep\"?"));
}

TEST_CASE("check warns of what is probably unintended") {
  const Workplace w;
  write_text(w.path / "odd.json", R"({"terrazzo": 1, "nodes": {
 "n": {"type": "load_map", "path": "photo.png", "semantic": "normal"}, "c": {"type": "convert_color", "image": "@n"},
 "p": {"type": "pattern", "kind": "gravel", "size": 64},
 "w": {"type": "weight", "material": "@p", "weights": {"height": 0}}, "s": {"type": "pca", "features": "@w"},
 "i": {"type": "index", "appearance": "@s"}, "a": {"type": "save_analysis", "index": "@i", "path": "a.tza"},
 "f": {"type": "export", "material": "@c", "path": "x.png"}}})");
  const ProgramRun run = w.run({"check", "odd.json"});
  CHECK(run.code == 0);
  CHECK(contains(run.err, "warning: odd.json:2:"));
  CHECK(contains(run.err, "a normal map holds directions, not colours"));
  CHECK(contains(run.err, "warning: odd.json:4:56: "));
  CHECK(contains(run.err, "the weight of height is 0"));
}

TEST_CASE("synth makes twice the exemplar unless it is told otherwise, and warns of less surface") {
  const Workplace w;
  REQUIRE(w.run({"run", std::string(TERRAZZO_SOURCE_DIR) + "/graphs/generate-exemplar.json", "--set", "type=gravel",
                 "--set", "size=32x40", "--set", "out=stone"})
              .code == 0);
  CHECK(w.run({"synth", "stone", "-o", "twice", "--quality", "draft"}).code == 0);
  CHECK(read_image_info(w.path / "twice/height.png").size == Size{64, 80});
  CHECK(w.run({"synth", "stone", "-o", "more", "--quality", "draft", "--scale", "1.5"}).code == 0);
  CHECK(read_image_info(w.path / "more/height.png").size == Size{48, 60});
  const ProgramRun less = w.run({"synth", "stone", "-o", "less", "--quality", "draft", "--size", "20x20"});
  CHECK(less.code == 0);
  CHECK(contains(less.err, "the result, 20x20, shows less surface than the exemplar, 32x40"));
  CHECK(w.run({"synth", "stone", "-o", "x", "--scale", "2", "--size", "9"}).code == 2);
}

TEST_CASE("group --to puts the subgraph into a file that another graph can use") {
  const Workplace w;
  CHECK(w.run({"run", "soft.json"}).code == 0);
  const std::string picture = read_text(w.path / "out/base_color.png");
  const ProgramRun run =
      w.run({"group", "soft.json", "blurred", "soft", "--to", "parts/blurred.json", "-o", "new.json"});
  CAPTURE(run.err);
  REQUIRE(run.code == 0);
  CHECK(contains(read_text(w.path / "new.json"), "\"type\": \"parts/blurred.json\""));
  CHECK_FALSE(contains(read_text(w.path / "new.json"), "\"graphs\""));
  fs::remove_all(w.path / "out");
  CHECK(w.run({"run", "new.json"}).code == 0);
  CHECK(read_text(w.path / "out/base_color.png") == picture);
  CHECK(w.run({"check", "parts/blurred.json"}).code == 0);
  const ProgramRun again = w.run({"group", "soft.json", "blurred", "soft", "--to", "parts/blurred.json"});
  CHECK(again.code == 2);
  CHECK(contains(again.err, "the file exists"));
}

TEST_CASE("group, ungroup, format and diff on files") {
  const Workplace w;
  const std::string before = read_text(w.path / "soft.json");
  REQUIRE(w.run({"format", "soft.json", "-o", "plain.json"}).code == 0);
  CHECK(w.run({"format", "plain.json", "--check"}).code == 0);
  const ProgramRun grouped = w.run({"group", "plain.json", "part", "soft", "-o", "grouped.json"});
  CHECK_MESSAGE(grouped.code == 0, grouped.err);
  const ProgramRun diff = w.run({"diff", "plain.json", "grouped.json"});
  CHECK(diff.code == 1);
  CHECK(contains(diff.out, "graph \"part\" is new"));
  REQUIRE(w.run({"ungroup", "grouped.json", "part"}).code == 0);
  CHECK(read_text(w.path / "grouped.json") == read_text(w.path / "plain.json"));
  CHECK(w.run({"diff", "soft.json", "grouped.json"}).code == 0);
  CHECK(read_text(w.path / "soft.json") == before);
  const ProgramRun misspelt = w.run({"group", "plain.json", "part", "sof"});
  CHECK(misspelt.code == 2);
  CHECK(contains(misspelt.err, "did you mean \"soft\"?"));
}

TEST_CASE("a pack runs where nothing else is") {
  const Workplace w;
  const ProgramRun packed = w.run({"pack", "soft.json", "-o", "there/soft.tzpack"});
  CHECK_MESSAGE(packed.code == 0, packed.err);
  CHECK(contains(packed.err, "the graph and 1 file"));
  fs::remove(w.path / "photo.png");
  fs::remove(w.path / "soft.json");
  const ProgramRun run = w.run({"run", "there/soft.tzpack", "--set", "radius=2"});
  CHECK_MESSAGE(run.code == 0, run.err);
  CHECK(fs::exists(w.path / "there/out/base_color.png"));
  CHECK(contains(w.run({"run", "there/soft.tzpack", "--help"}).out, "radius"));
}

TEST_CASE("only runs what a subgraph or a round of a loop has") {
  const Workplace w;
  write_text(w.path / "loop.json", R"({"terrazzo": 1, "graphs": {"save": {"parameters": {"v": {"type": "number"}},
    "nodes": {"s": {"type": "solid", "size": 8, "value": ["$v"]}, "f": {"type": "export", "material": "@s", "path": "v$v.png"}}}},
    "nodes": {"all": {"type": "save", "foreach": {"values": [0.25, 0.5]}, "v": "$item"}}})");
  const ProgramRun run = w.run({"run", "loop.json", "--only", "all[0.5]"});
  CHECK_MESSAGE(run.code == 0, run.err);
  CHECK_FALSE(fs::exists(w.path / "v0.25.png"));
  CHECK(fs::exists(w.path / "v0.5.png"));
  CHECK(w.run({"run", "loop.json", "--only", "all"}).code == 0);
  CHECK(fs::exists(w.path / "v0.25.png"));
}
