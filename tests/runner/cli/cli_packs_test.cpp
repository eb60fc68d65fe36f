#include <filesystem>

#include <doctest/doctest.h>

#include "tests/runner/program.h"
#include "tests/runner/workplace.h"
#include "tests/texts.h"

using namespace terrazzo;
using namespace terrazzo::test;

namespace fs = std::filesystem;

namespace {

/// A workplace with soft.json packed as there/soft.tzpack.
struct PackedWorkplace : Workplace {
  PackedWorkplace() { REQUIRE(run({"pack", "soft.json", "-o", "there/soft.tzpack"}).code == 0); }
};

}  // namespace

TEST_CASE("a pack is unpacked into the cache that is named, and nowhere without one") {
  const PackedWorkplace w;
  const ProgramRun named = w.run({"run", "there/soft.tzpack", "--cache", "mine"});
  CHECK_MESSAGE(named.code == 0, named.err);
  CHECK(fs::exists(w.path / "mine/packs"));
  REQUIRE_FALSE(fs::is_empty(w.path / "mine/packs"));
  const fs::path copy = fs::directory_iterator(w.path / "mine/packs")->path();
  fs::remove_all(copy / "inputs");
  const ProgramRun again = w.run({"run", "there/soft.tzpack", "--cache", "mine"});
  CHECK_MESSAGE(again.code == 0, again.err);
  CHECK(fs::exists(copy / "inputs"));
  const ProgramRun without = w.run({"run", "there/soft.tzpack", "--no-cache"});
  CHECK_MESSAGE(without.code == 0, without.err);
}

TEST_CASE("a parameter that a pack's own inputs stand in for is not called unused") {
  const Workplace w;
  write_text(w.path / "in.json", R"({"terrazzo": 1, "parameters": {"photo": {"type": "path"}}, "nodes": {
 "p": {"type": "load_map", "path": "$photo"}, "f": {"type": "export", "material": "@p", "path": "{map}.png"}}})");
  REQUIRE(w.run({"pack", "in.json", "--set", "photo=photo.png", "-o", "there/in.tzpack"}).code == 0);
  const ProgramRun run = w.run({"run", "there/in.tzpack"});
  CHECK_MESSAGE(run.code == 0, run.err);
  CHECK_FALSE(contains(run.err, "no node uses it"));
  write_picture(w.path / "other.png", 5);
  CHECK(w.run({"run", "there/in.tzpack", "--set", "photo=other.png"}).code == 0);
  CHECK(read_text(w.path / "there/base_color.png") != "");
}

TEST_CASE("a pack runs in its sandbox, which it cannot leave") {
  const PackedWorkplace w;
  const ProgramRun inside = w.run({"run", "there/soft.tzpack", "--sandbox", "there"});
  CHECK_MESSAGE(inside.code == 0, inside.err);
  fs::create_directories(w.path / "other");
  const ProgramRun outside = w.run({"run", "there/soft.tzpack", "--sandbox", "other"});
  CHECK(outside.code == 2);
  CHECK(contains(outside.err, "may not write"));
}

TEST_CASE("commands that do not take packs say so") {
  const PackedWorkplace w;
  const std::string pack = "there/soft.tzpack", before = read_text(w.path / pack);
  for (const std::vector<std::string>& words : {std::vector<std::string>{"format", pack},
                                                {"upgrade", pack},
                                                {"diff", pack, "soft.json"},
                                                {"diff", "soft.json", pack},
                                                {"group", pack, "g", "soft"},
                                                {"ungroup", pack, "g"},
                                                {"pack", pack, "-o", "again.tzpack"}}) {
    const ProgramRun run = w.run(words);
    CAPTURE(words.front());
    CHECK(run.code == 2);
    CHECK(contains(run.err, "expected a graph file, found a pack or another tar archive"));
  }
  CHECK(read_text(w.path / pack) == before);
  CHECK(w.run({"check", pack}).code == 0);
  CHECK(w.run({"draw", pack, "-o", "drawn.svg"}).code == 0);
}

TEST_CASE("paths that are written as on Windows are named, and nothing is made of them") {
  const Workplace w;
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"run", "soft.json", "--report", "out\\run.html"},
        {"run", "soft.json", "--set", "out=out\\wall.png"},
        {"synth", "scans\\brick", "-o", "out"},
        {"new", "scans", "-o", "a\\b.json"},
        {"pack", "soft.json", "-o", "a\\b.tzpack"},
        {"draw", "soft.json", "-o", "a\\b.svg"}}) {
    const ProgramRun run = w.run(words);
    CAPTURE(run.err);
    CHECK(run.code == 2);
    CHECK(contains(run.err, "folders are separated by /: write"));
  }
  CHECK(contains(w.run({"synth", "scans", "-o", "C:\\out"}).err, "C: is a drive of Windows"));
  for (const std::string& name : listing(w.path)) CHECK(name.find('\\') == std::string::npos);
}

TEST_CASE("watching and a dry run exclude each other") {
  const Workplace w;
  const ProgramRun run = w.run({"run", "soft.json", "--watch", "--dry-run"});
  CHECK(run.code == 2);
  CHECK(contains(run.err, "--dry-run excludes --watch"));
}

TEST_CASE("an input of a graph is told from a node, and how it is given") {
  const Workplace w;
  write_text(w.path / "lit.json", R"({"terrazzo": 1, "inputs": {"material": {"type": "material"}}, "nodes": {
 "p": {"type": "preview", "material": "@material"}, "f": {"type": "export", "material": "@p", "path": "lit.png"}}})");
  CHECK(contains(w.run({"run", "lit.json", "--set", "material=photo.png"}).err,
                 "\"material\" is an input, which takes a wire: make the graph a node of another one"));
  CHECK(contains(w.run({"run", "lit.json", "--set", "material.path=photo.png"}).err, "\"material\" is an input"));
}

TEST_CASE("help on a pack that cannot be read says why, and ends with code 2 like other wrong words") {
  const PackedWorkplace w;
  const fs::path pack = w.path / "there/soft.tzpack";
  CHECK(w.run({"run", "there/soft.tzpack", "--help"}).code == 0);
  fs::resize_file(pack, fs::file_size(pack) / 3);
  const ProgramRun cut = w.run({"run", "there/soft.tzpack", "--help"});
  CHECK(cut.code == 2);
  CHECK_MESSAGE(contains(cut.err, "soft.tzpack"), cut.err);
  CHECK(cut.out.empty());
}

TEST_CASE("a pack runs on another folder than the one it was packed with") {
  const Workplace w;
  write_picture(w.path / "maps/wall_color.png", 5);
  write_picture(w.path / "other/floor_color.png", 7);
  REQUIRE(w.run({"new", "maps", "-o", "wall.json"}).code == 0);
  REQUIRE(w.run({"pack", "wall.json", "-o", "wall.tzpack"}).code == 0);
  std::filesystem::remove_all(w.path / "maps");
  const auto colours = [&](const std::vector<std::string>& command) {
    std::vector<std::string> args = command;
    args.insert(args.end(), {"--set", "size=32x32", "--set", "out=out"});
    const ProgramRun run = w.run(args);
    CHECK_MESSAGE(run.code == 0, run.err);
    return read_text(w.path / "out/base_color.png");
  };
  const std::string own = colours({"run", "wall.tzpack"});
  const std::string other = colours({"run", "wall.tzpack", "--set", "material=other/"});
  CHECK(other != own);
  CHECK(other == colours({"run", "wall.json", "--set", "material=other"}));
}
