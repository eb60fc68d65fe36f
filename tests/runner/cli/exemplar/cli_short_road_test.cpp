#include <doctest/doctest.h>

#include "core/image_io/image_file.h"
#include "tests/runner/fakes.h"
#include "tests/runner/program.h"
#include "tests/runner/workplace.h"
#include "tests/texts.h"

/// From a picture or a folder of several materials to what an engine reads, and stock graphs by name, in one command.
using namespace terrazzo;
using namespace terrazzo::test;
namespace fs = std::filesystem;

namespace {

ProgramRun made(const Workplace& w, std::vector<std::string> args) {
  args.insert(args.end(), {"--size", "32x32", "--quality", "draft"});
  ProgramRun run = w.run(args);
  CHECK_MESSAGE(run.code == 0, run.err);
  return run;
}

}  // namespace

TEST_CASE("synth makes more of a single picture, as the stock graph texture does") {
  const Workplace w;
  write_picture(w.path / "shots/wall.png", 5);
  write_picture(w.path / "shots/other_normal.png", 7);
  made(w, {"synth", "shots/wall.png", "-o", "out"});
  REQUIRE(fs::exists(w.path / "out/base_color.png"));
  CHECK_FALSE(fs::exists(w.path / "out/normal.png"));
  CHECK(w.run({"run", "stock:texture", "--set", "image=shots/wall.png", "--set", "size=32x32", "--set", "quality=draft",
               "--set", "out=same"})
            .code == 0);
  CHECK(read_text(w.path / "out/base_color.png") == read_text(w.path / "same/base_color.png"));
  const ProgramRun noise = w.run({"synth", "shots/wall.png", "-o", "noise", "--method", "noise", "--size", "32x32"});
  CHECK_MESSAGE(noise.code == 0, noise.err);

  CHECK(contains(w.run({"synth", "shots/wall.png", "-o", "x", "--name", "wall"}).err, "is a picture; name its folder"));
  CHECK(contains(w.run({"synth", "shots/wall.png", "-o", "x", "--interpret", "normal=xy"}).err, "taken as base_color"));
  write_text(w.path / "notes.json", "{}");
  CHECK(contains(w.run({"synth", "notes.json", "-o", "x"}).err, "FOLDER: cannot read"));
}

TEST_CASE("new begins with texture for a picture, and says which stock graphs take which") {
  const Workplace w;
  write_picture(w.path / "wall.png", 5);
  write_picture(w.path / "maps/wall_color.png", 5);
  const ProgramRun run = w.run({"new", "wall.png", "-o", "wall.json"});
  CHECK_MESSAGE(run.code == 0, run.err);
  CHECK(contains(read_text(w.path / "wall.json"),
                 "\"image\": {\"type\": \"path\", \"help\": \"the exemplar\", \"default\": \"wall.png\"}"));
  CHECK(w.run({"run", "wall.json", "--set", "out=out", "--set", "size=32x32", "--set", "quality=draft"}).code == 0);
  CHECK(contains(w.run({"new", "wall.png", "-o", "x.json", "--like", "material"}).err,
                 "--like material: it takes a folder of maps, and wall.png is a picture"));
  CHECK(contains(w.run({"new", "maps", "-o", "x.json", "--like", "texture"}).err,
                 "--like texture: it takes a picture, and maps is a folder of maps"));
  CHECK(contains(w.run({"new", "wall.png", "-o", "x.json", "--like", "textur"}).err, "did you mean \"texture\"?"));
}

TEST_CASE("synth makes every material of a folder, each in a folder of its name, unless options are for one") {
  const Workplace w;
  write_picture(w.path / "pack/Concrete07_Color.png", 5);
  write_picture(w.path / "pack/Leather05_Color.png", 7);
  write_picture(w.path / "pack/Leather05_Roughness.png", 3);
  const ProgramRun run = made(w, {"synth", "pack", "-o", "out"});
  CHECK_MESSAGE(contains(run.err, "2 materials; --name NAME makes one of them"), run.err);
  CHECK(fs::exists(w.path / "out/Concrete07/base_color.png"));
  CHECK(fs::exists(w.path / "out/Leather05/roughness.png"));
  made(w, {"synth", "pack", "-o", "by/{material}/maps"});
  CHECK(fs::exists(w.path / "by/Leather05/maps/roughness.png"));
  const ProgramRun one = w.run({"synth", "pack", "-o", "out", "--report", "r.html"});
  CHECK(one.code == 2);
  CHECK(contains(one.err, "--report: pack holds 2 materials (Concrete07, Leather05), and it is for one"));

  // One that fails keeps the others from nothing, but is told.
  write_text(w.path / "pack/Broken_Color.png", "no picture");
  const ProgramRun broken = w.run({"synth", "pack", "-o", "rest", "--size", "32x32", "--quality", "draft"});
  CHECK(broken.code != 0);
  CHECK_MESSAGE(contains(broken.err, "Broken_Color.png"), broken.err);
  CHECK(fs::exists(w.path / "rest/Leather05/roughness.png"));
}

TEST_CASE("synth writes what an engine reads, or some maps only; wrong names are told with the nearest") {
  const Workplace w;
  write_picture(w.path / "maps/wall_color.png", 5);
  write_picture(w.path / "maps/wall_roughness.png", 7);
  made(w, {"synth", "maps", "-o", "unreal", "--engine", "unreal"});
  CHECK(fs::exists(w.path / "unreal/T_maps_BaseColor.png"));
  CHECK(fs::exists(w.path / "unreal/T_maps_ORM.png"));
  made(w, {"synth", "maps/wall_color.png", "-o", "gltf", "--engine", "gltf"});
  CHECK(fs::exists(w.path / "gltf/wall_color.gltf"));
  made(w, {"synth", "maps", "-o", "some", "--maps", "roughness"});
  CHECK(fs::exists(w.path / "some/roughness.png"));
  CHECK_FALSE(fs::exists(w.path / "some/base_color.png"));

  const ProgramRun engine = w.run({"synth", "maps", "-o", "x", "--engine", "unrael"});
  CHECK(engine.code == 2);
  CHECK_MESSAGE(contains(engine.err, "found unrael (did you mean \"unreal\"?)"), engine.err);
  const ProgramRun map = w.run({"synth", "maps", "-o", "x", "--maps", "roughnes, base_color"});
  CHECK(map.code == 2);
  CHECK_MESSAGE(contains(map.err, "--maps: there is no map \"roughnes\" (did you mean \"roughness\"?)"), map.err);
  CHECK(w.run({"synth", "maps", "-o", "x", "--maps", "roughness", "--engine", "unreal"}).code == 2);
}

TEST_CASE("stock graphs stand wherever a graph file does, and are not written to") {
  const Workplace w;
  CHECK(w.run({"check", "stock:engine"}).code == 0);
  CHECK(w.run({"draw", "stock:engine", "-o", "engine.svg"}).code == 0);
  CHECK(contains(w.run({"run", "stock:material", "--help"}).out, "folder of the exemplar's maps"));
  CHECK(contains(w.run({"run", "stock:materal"}).err, "no graph of that name (did you mean \"material\"?)"));
  CHECK(contains(w.run({"format", "stock:engine"}).err, "is part of the program; -o FILE.json names a file"));
  CHECK(w.run({"format", "stock:engine", "-o", "mine.json"}).code == 0);
  CHECK(w.run({"check", "mine.json"}).code == 0);
}

TEST_CASE("new puts a node that takes out the light where check sees some, and check is content with the graph") {
  const Workplace w;
  const auto photo = [&](const fs::path& path, double brightening) {
    std::vector<float> pixels;
    for (int y = 0; y < 64; y++)
      for (int x = 0; x < 96; x++)
        for (int c = 0; c < 3; c++)
          pixels.push_back(float((0.3 + 0.2 * ((x * 7 + y * 13) % 11) / 10) * (1 + brightening * x / 95)));
    fs::create_directories(path.parent_path());
    write_image(*Image::from_floats({.size = {96, 64},
                                     .channels = 3,
                                     .semantic = Semantic::base_color,
                                     .color_space = "srgb_texture",
                                     .depth = Depth::u8},
                                    std::move(pixels)),
                path, {}, [](double) {});
  };
  photo(w.path / "maps/wall_color.png", 0.8);
  photo(w.path / "even/wall_color.png", 0);
  photo(w.path / "wall.png", 0.8);
  for (const std::string from : {"maps", "wall.png"}) {
    const ProgramRun run = w.run({"new", from, "-o", from + ".json"});
    CHECK_MESSAGE(run.code == 0, run.err);
    CHECK_MESSAGE(contains(run.err, "brighter at the right than at the left"), run.err);
    const std::string graph = read_text(w.path / (from + ".json"));
    CHECK(contains(graph, "{\"type\": \"delight\", \"material\": \"@exemplar\"}"));
    CHECK(contains(graph, "\"material\": \"@even_light\""));
    const ProgramRun check = w.run({"check", from + ".json"});
    CHECK(check.code == 0);
    CHECK_FALSE_MESSAGE(contains(check.err + check.out, "baked in"), check.err);
    const ProgramRun made =
        w.run({"run", from + ".json", "--set", "out=out", "--set", "size=32x32", "--set", "quality=draft"});
    CHECK_MESSAGE(contains(made.err, "slow light: the brightest place had"), made.err);
  }
  CHECK(w.run({"new", "even", "-o", "even.json"}).code == 0);
  CHECK_FALSE(contains(read_text(w.path / "even.json"), "delight"));
  const ProgramRun check = w.run({"check", "even.json", "--set", "material=maps"});
  CHECK_MESSAGE(contains(check.err + check.out, "The node \"delight\" takes it out"), check.err);
}

TEST_CASE("new and check tell where an exemplar shows something only once") {
  const Workplace w;
  const auto photo = [&](const std::string& folder, bool spot) {
    std::vector<float> pixels;
    for (int y = 0; y < 96; y++)
      for (int x = 0; x < 96; x++)
        for (int c = 0; c < 3; c++) {
          const bool inside = spot && (x - 60) * (x - 60) + (y - 30) * (y - 30) < 40;
          pixels.push_back(inside ? float(c == 0) : float(0.3 + 0.2 * ((x * 7 + y * 13) % 11) / 10));
        }
    fs::create_directories(w.path / folder);
    write_image(*Image::from_floats({.size = {96, 96},
                                     .channels = 3,
                                     .semantic = Semantic::base_color,
                                     .color_space = "srgb_texture",
                                     .depth = Depth::u8},
                                    std::move(pixels)),
                w.path / folder / "wall_color.png", {}, [](double) {});
  };
  photo("maps", true);
  photo("plain", false);
  for (const bool spot : {true, false}) {
    const std::string folder = spot ? "maps" : "plain", graph = folder + ".json";
    const ProgramRun made = w.run({"new", folder, "-o", graph});
    CHECK_MESSAGE(made.code == 0, made.err);
    CHECK_MESSAGE(contains(made.err, "only once") == spot, made.err);
    const ProgramRun check = w.run({"check", graph});
    CHECK(check.code == 0);
    CHECK_MESSAGE(contains(check.err + check.out, "only once; a result repeats it") == spot, check.err);
  }
}

TEST_CASE("what cannot be made is told by the argument that asked for it") {
  const Workplace w;
  write_picture(w.path / "maps/wall_color.png", 5);
  const ProgramRun run = w.run({"synth", "maps", "-o", "out", "--engine", "gltf", "--format", "tga"});
  CHECK(run.code == 2);
  CHECK_MESSAGE(contains(run.err, "error: --format tga: gltf takes png or jpg, found \"tga\""), run.err);
  write_picture(w.path / "maps/wall_normal.png", 6);
  const ProgramRun normals = w.run({"synth", "maps", "-o", "out", "--interpret", "normal=dxt5nm"});
  CHECK(normals.code == 2);
  CHECK_MESSAGE(contains(normals.err, "error: --interpret: normal: wall_normal.png: it has 3 channels"), normals.err);
  const ProgramRun misspelt = w.run({"synth", "maps/wall_colour.png", "-o", "out"});
  CHECK(misspelt.code == 2);
  CHECK_MESSAGE(contains(misspelt.err, "wall_colour.png (did you mean \"wall_color.png\"?)"), misspelt.err);
  CHECK(contains(w.run({"synth", "maps", "-o", "a", "-o", "b"}).err, "--out: expected once, found 2 times"));
}

TEST_CASE("a stock graph for folders takes a picture as well") {
  const Workplace w;
  write_picture(w.path / "wall.png", 5);
  const ProgramRun run = w.run({"run", "stock:material", "--set", "material=wall.png", "--set", "quality=draft"});
  CHECK_MESSAGE(run.code == 0, run.err);
  CHECK(std::filesystem::exists(w.path / "out/base_color.png"));
}
