#include <doctest/doctest.h>

#include "core/image_io/image_file.h"
#include "test_paths.h"
#include "tests/runner/fakes.h"
#include "tests/runner/program.h"
#include "tests/runner/workplace.h"

/// `synth` and the stock graphs.
using namespace terrazzo;
using namespace terrazzo::test;
namespace fs = std::filesystem;

namespace {

/// The bytes of one map of what `synth` makes of the folder "stone", into the folder `name`.
std::string map_of_stone(const Workplace& w, const char* map, const std::string& name,
                         const std::vector<std::string>& options) {
  std::vector<std::string> args = {"synth", "stone", "-o", name, "--size", "48x48"};
  args.insert(args.end(), options.begin(), options.end());
  const ProgramRun r = w.run(args);
  CHECK_MESSAGE(r.code == 0, r.err);
  return read_text(w.path / name / map);
}

}  // namespace

TEST_CASE("synth makes a larger material without a graph file") {
  const Workplace w;
  write_picture(w.path / "maps/stone_basecolor.png", 5);
  const ProgramRun r = w.run({"synth", "maps", "-o", "big", "--size", "48x40", "--seed", "3"});
  CHECK_MESSAGE(r.code == 0, r.err);
  const FileInfo info = read_image_info(w.path / "big/base_color.png");
  CHECK(info.size == Size{48, 40});

  const ProgramRun other = w.run({"synth", "maps", "-o", "big", "--size", "48x40", "--seed", "4"});
  CHECK(other.code == 0);
  CHECK_MESSAGE(other.err.find("10 stages: 6 cached, 4 run, ") != std::string::npos, other.err);
  CHECK(other.err.find("warning") == std::string::npos);
}

TEST_CASE("synth --tileable asks for a result that wraps, and synth never overwrites its exemplar") {
  const Workplace w;
  write_picture(w.path / "maps/stone_basecolor.png", 5);
  const ProgramRun plain = w.run({"synth", "maps", "-o", "plain", "--size", "40x40"});
  const ProgramRun wraps = w.run({"synth", "maps", "-o", "wraps", "--size", "40x40", "--tileable"});
  const ProgramRun sideways = w.run({"synth", "maps", "-o", "sideways", "--size", "40x40", "--tileable=x"});
  CHECK_MESSAGE(sideways.code == 0, sideways.err);
  const ProgramRun wrong = w.run({"synth", "maps", "-o", "wrong", "--tileable=z"});
  CHECK(wrong.code == 2);
  CHECK_MESSAGE(contains(wrong.err, "--tileable z: expected"), wrong.err);
  CHECK(contains(w.run({"synth", "maps", "-o", "wrong", "--tileable", "x"}).err, "did you mean --tileable=x?"));
  REQUIRE(plain.code == 0);
  REQUIRE(wraps.code == 0);
  CHECK(read_text(w.path / "plain/base_color.png") != read_text(w.path / "wraps/base_color.png"));
  const ProgramRun onto = w.run({"synth", "maps", "-o", "maps"});
  CHECK(onto.code == 2);
  CHECK(onto.err.find("would overwrite the exemplar") != std::string::npos);
}

TEST_CASE("synth takes a quality, and draft is another result than normal") {
  const Workplace w;
  write_picture(w.path / "stone/base_color.png", 5);
  for (const std::string quality : {"draft", "normal"}) {
    const ProgramRun r = w.run({"synth", "stone", "-o", quality, "--size", "48x48", "--quality", quality});
    CHECK_MESSAGE(r.code == 0, r.err);
  }
  CHECK(w.run({"synth", "stone", "-o", "unset", "--size", "48x48"}).code == 0);
  CHECK(read_text(w.path / "unset/base_color.png") == read_text(w.path / "normal/base_color.png"));
  CHECK(read_text(w.path / "draft/base_color.png") != read_text(w.path / "normal/base_color.png"));
  CHECK(w.run({"synth", "stone", "-o", "x", "--quality", "great"}).code == 2);
}

TEST_CASE("synth blends seams as far as it is told to, none unless told, and refuses what resolve_uv would refuse") {
  const Workplace w;
  write_picture(w.path / "stone/base_color.png", 5);
  const auto result = [&](const std::string& name, const std::vector<std::string>& options) {
    return map_of_stone(w, "base_color.png", name, options);
  };
  const std::string exact = result("unset", {});
  CHECK(result("zero", {"--blend", "0"}) == exact);
  const std::string soft = result("soft", {"--blend", "2.5"});
  CHECK(soft != exact);
  const ProgramRun graph = w.run({"run", TERRAZZO_SOURCE_DIR "/graphs/material.json", "--set", "material=stone",
                                  "--set", "size=48x48", "--set", "out=graph", "--set", "blend=2.5"});
  CHECK_MESSAGE(graph.code == 0, graph.err);
  CHECK(read_text(w.path / "graph/base_color.png") == soft);
  for (const std::string wrong : {"9", "-1", "nan", "much"}) {
    const ProgramRun r = w.run({"synth", "stone", "-o", "x", "--blend", wrong});
    CHECK(r.code == 2);
    CHECK_MESSAGE(r.err.find("--blend " + wrong + ": expected a number from 0 to 8") != std::string::npos, r.err);
  }
}

TEST_CASE("synth joins heights as far as it is told to, and leaves them as they are if told so") {
  const Workplace w;
  write_picture(w.path / "stone/base_color.png", 5);
  write_picture(w.path / "stone/height.png", 6);
  const auto result = [&](const std::string& name, const std::vector<std::string>& options) {
    return map_of_stone(w, "height.png", name, options);
  };
  const std::string joined = result("unset", {});
  CHECK(result("same", {"--join", "0.03"}) == joined);
  const std::string exact = result("exact", {"--join", "0"});
  CHECK(exact != joined);
  CHECK(read_text(w.path / "exact/base_color.png") == read_text(w.path / "unset/base_color.png"));
  for (const std::string wrong : {"-1", "nan", "far"}) {
    const ProgramRun r = w.run({"synth", "stone", "-o", "x", "--join", wrong});
    CHECK(r.code == 2);
    CHECK_MESSAGE(r.err.find("--join " + wrong + ": expected a number from 0 to 1024") != std::string::npos, r.err);
  }
}

TEST_CASE("formats go by all their names, in upper and lower case, and a wrong one is told with the right ones") {
  const Workplace w;
  write_picture(w.path / "stone/base_color.png", 5);
  for (const auto& [given, extension] :
       {std::pair("tiff", "tiff"), {"TIF", "tif"}, {"PNG", "png"}, {"JPEG", "jpeg"}, {"jpg", "jpg"}}) {
    CAPTURE(given);
    const ProgramRun r =
        w.run({"synth", "stone", "-o", given, "--size", "40x40", "--quality", "DRAFT", "--format", given});
    CHECK_MESSAGE(r.code == 0, r.err);
    CHECK(listing(w.path / given) == std::vector<std::string>{std::string("base_color.") + extension});
    CHECK(read_image_info(w.path / given / ("base_color." + std::string(extension))).size == Size{40, 40});
  }
  const ProgramRun set =
      w.run({"run", TERRAZZO_SOURCE_DIR "/graphs/material.json", "--set", "material=stone", "--set", "size=40x40",
             "--set", "out=set", "--set", "format=TIFF", "--set", "layout.quality=Draft"});
  CHECK_MESSAGE(set.code == 0, set.err);
  CHECK(read_text(w.path / "set/base_color.tiff") == read_text(w.path / "tiff/base_color.tiff"));
  const ProgramRun wrong =
      w.run({"synth", "stone", "-o", "x", "--format", "pgn", "--size", "big", "--quality", "great"});
  CHECK(wrong.code == 2);
  CHECK_MESSAGE(contains(wrong.err,
                         "--format pgn: expected \"png\", \"tif\", \"tiff\", \"exr\", \"jpg\" or \"jpeg\", found "
                         "the text \"pgn\" (did you mean \"png\"?)"),
                wrong.err);
  CHECK(contains(wrong.err, "--size big: expected a size"));
  CHECK(contains(wrong.err, "--quality great: expected \"draft\", \"normal\" or \"best\""));
  CHECK_FALSE(contains(wrong.err, "override"));
  CHECK_FALSE(fs::exists(w.path / "x"));
}

TEST_CASE("synth tells of a missing folder and of a wrong value in one go") {
  const Workplace w;
  const ProgramRun r = w.run({"synth", "missing", "-o", "x", "--quality", "fast"});
  CHECK(r.code == 2);
  CHECK_MESSAGE(contains(r.err, "error: FOLDER: there is no folder or picture "), r.err);
  CHECK_MESSAGE(contains(r.err, "error: --quality fast: expected \"draft\", \"normal\" or \"best\""), r.err);
}

TEST_CASE("synth names the option, and what it takes, of a seed or size that no node would take") {
  const Workplace w;
  write_picture(w.path / "stone/base_color.png", 5);
  const ProgramRun r = w.run({"synth", "stone", "-o", "x", "--seed", "-1", "--size", "40000"});
  CHECK(r.code == 2);
  CHECK_MESSAGE(
      r.err ==
          "error: --size 40000: expected a size such as [512, 256], \"512x256\" or 512, sides from 1 to 32768, "
          "found the number 40000\nerror: --seed -1: expected an integer of at least 0, found the number -1\n",
      r.err);
  CHECK(contains(w.run({"synth", "stone", "-o", "x", "--size", "64x40000"}).err, "--size 64x40000: expected a size"));
  CHECK(contains(w.run({"synth", "stone", "-o", "x", "--seed", "99999999999999999999"}).err,
                 "--seed 99999999999999999999: expected an integer from 0 to 9223372036854775807, found the number "
                 "99999999999999999999"));
  CHECK_FALSE(fs::exists(w.path / "x"));
}

TEST_CASE("sizes may have a capital X") {
  const Workplace w;
  write_picture(w.path / "stone/base_color.png", 5);
  const ProgramRun r = w.run({"synth", "stone", "-o", "big", "--size", "48X40", "--quality", "draft"});
  CHECK_MESSAGE(r.code == 0, r.err);
  CHECK(read_image_info(w.path / "big/base_color.png").size == Size{48, 40});
}

TEST_CASE("the stock graphs that steer synthesis run") {
  const Workplace w;
  write_picture(w.path / "maps/stone_basecolor.png", 5);
  const std::string graphs = TERRAZZO_SOURCE_DIR "/graphs/", picture = "maps/stone_basecolor.png";
  const auto makes = [&](const std::string& graph, std::vector<std::string> settings) {
    std::vector<std::string> args = {"run",         graphs + graph + ".json", "--set", "material=maps", "--set",
                                     "out=" + graph};
    for (const std::string& s : settings) args.insert(args.end(), {"--set", s});
    const ProgramRun run = w.run(args);
    CHECK_MESSAGE(run.code == 0, run.err);
    CHECK(fs::exists(w.path / graph / "base_color.png"));
  };
  makes("make_tileable", {"border=4"});
  makes("inpaint", {"mask=" + picture});
  makes("transfer", {"target=" + picture, "size=40x40"});
}

TEST_CASE("magnify refuses an analysis larger than the exemplar before anything runs") {
  const Workplace w;
  const std::string graph = TERRAZZO_SOURCE_DIR "/graphs/magnify.json";
  const ProgramRun r = w.run({"run", graph, "--set", "material=.", "--set", "analysed=2"});
  CHECK(r.code == 2);
  CHECK_MESSAGE(r.err.find("analysed") != std::string::npos, r.err);
}

TEST_CASE("-o may name places that the material and the result fill in, and says which if it cannot") {
  const Workplace w;
  write_picture(w.path / "stone/base_color.png", 5);
  const ProgramRun r = w.run({"synth", "stone", "-o", "{material} {width}/{map}", "--size", "48x40"});
  CHECK_MESSAGE(r.code == 0, r.err);
  CHECK(fs::exists(w.path / "stone 48/base_color/base_color.png"));
  const ProgramRun wrong = w.run({"synth", "stone", "-o", "out {seed}"});
  CHECK(wrong.code == 2);
  CHECK_MESSAGE(contains(wrong.err, "error: -o"), wrong.err);
  CHECK_MESSAGE(contains(wrong.err, "unknown placeholder {seed}"), wrong.err);
  CHECK(contains(w.run({"synth", "--help"}).out, "{material}"));
}

TEST_CASE("the stock graph that extends keeps what synth has made, pixel by pixel, whole stones too") {
  const Workplace w;
  write_picture(w.path / "plain/base_color.png", 5);
  write_text(w.path / "cobbles.json", R"({"terrazzo": 1, "nodes": {
    "cobbles": {"type": "pattern", "kind": "cobbles", "size": 192, "scale": 4},
    "files":   {"type": "export", "material": "@cobbles", "path": "cobbles/{map}.png"}}})");
  REQUIRE(w.run({"run", "cobbles.json"}).code == 0);
  const auto keeps = [&](const std::string& material, Size size, Size larger) {
    const std::string made = material + " made", grown = material + " grown";
    const auto text = [](Size s) { return std::to_string(s.width) + "x" + std::to_string(s.height); };
    const ProgramRun first = w.run({"synth", material, "-o", made, "--size", text(size), "--seed", "3"});
    REQUIRE_MESSAGE(first.code == 0, first.err);
    const ProgramRun second = w.run({"run", TERRAZZO_SOURCE_DIR "/graphs/extend.json", "--set", "material=" + material,
                                     "--set", "kept=" + text(size), "--set", "size=" + text(larger), "--set",
                                     "at=[20,10]", "--set", "seed=3", "--set", "out=" + grown});
    REQUIRE_MESSAGE(second.code == 0, second.err);
    const auto picture = [&](const std::string& name) {
      return read_image(w.path / name / "base_color.png", ImageInfo{}, [](const std::string&) {});
    };
    REQUIRE(picture(grown)->size() == larger);
    CHECK(picture(grown)->read({20, 10, size.width, size.height}) == picture(made)->pixels());
  };
  keeps("plain", {40, 32}, {72, 48});
  keeps("cobbles", {220, 200}, {260, 230});
}

TEST_CASE("what extend, inpaint and make_tileable keep stays bit for bit in every map, heights that are joined too") {
  const Workplace w;
  const auto run = [&](const std::string& graph, std::vector<std::string> args) {
    args.insert(args.begin(), {"run", TERRAZZO_SOURCE_DIR "/graphs/" + graph + ".json", "--set", "material=stone",
                               "--set", "out=" + graph});
    const ProgramRun r = w.run(args);
    REQUIRE_MESSAGE(r.code == 0, r.err);
  };
  write_text(w.path / "stone.json", R"({"terrazzo": 1, "nodes": {
    "stone": {"type": "pattern", "kind": "gravel", "size": 64, "scale": 6, "tileable": false},
    "files": {"type": "export", "material": "@stone", "path": "stone/{map}.png"}}})");
  REQUIRE(w.run({"run", "stone.json"}).code == 0);
  write_text(w.path / "hole.json", R"({"terrazzo": 1, "nodes": {
    "spots": {"type": "noise", "size": 64, "scale": 3},
    "hole":  {"type": "threshold", "image": "@spots", "value": 0.6},
    "file":  {"type": "export", "material": "@hole", "path": "hole.png"}}})");
  const ProgramRun hole = w.run({"run", "hole.json"});
  REQUIRE_MESSAGE(hole.code == 0, hole.err);
  run("material", {"--set", "size=80x70"});
  run("extend", {"--set", "kept=80x70", "--set", "size=120x110", "--set", "at=[30,20]"});
  run("inpaint", {"--set", "mask=hole.png", "--set", "margin=0"});
  run("make_tileable", {"--set", "border=10"});
  const auto pixels = [&](const std::string& file, const Rect& part) {
    return read_image(w.path / file, ImageInfo{}, [](const std::string&) {})->read(part);
  };
  const std::vector<float> holes = pixels("hole.png", {0, 0, 64, 64});
  for (const std::string map : {"base_color", "normal", "height", "roughness"}) {
    CAPTURE(map);
    const std::string file = "/" + map + ".png";
    CHECK(pixels("material" + file, {0, 0, 80, 70}) == pixels("extend" + file, {30, 20, 80, 70}));
    CHECK(pixels("stone" + file, {10, 10, 44, 44}) == pixels("make_tileable" + file, {10, 10, 44, 44}));
    const std::vector<float> was = pixels("stone" + file, {0, 0, 64, 64}),
                             is = pixels("inpaint" + file, {0, 0, 64, 64});
    const size_t channels = was.size() / holes.size();
    int kept = 0, filled = 0;
    for (size_t i = 0; i < holes.size(); i++) {
      const bool same = std::equal(&was[i * channels], &was[i * channels] + channels, &is[i * channels]);
      if (holes[i] < 0.5f) REQUIRE(same);
      kept += holes[i] < 0.5f;
      filled += !same;
    }
    CHECK(kept > 1000);
    CHECK(filled > 100);
  }
}

TEST_CASE("synth and new advise what can be typed when a folder holds no maps") {
  const Workplace w;
  write_picture(w.path / "odd/one.png", 5);
  for (const std::vector<std::string>& command :
       {std::vector<std::string>{"synth", "odd", "-o", "x"}, {"new", "odd", "-o", "x.json"}}) {
    const ProgramRun r = w.run(command);
    CHECK_MESSAGE(contains(r.err,
                           "; rename the files, or name them explicitly: `terrazzo run graphs/material.json --set "
                           "material=odd --set 'exemplar.maps={\"base_color\": \"FILE\"}' --set out=OUT`"),
                  r.err);
    CHECK_FALSE(contains(r.err, "the parameter `maps`"));
  }
  const ProgramRun named =
      w.run({"run", TERRAZZO_SOURCE_DIR "/graphs/material.json", "--set", "material=odd", "--set",
             R"(exemplar.maps={"base_color": "one.png"})", "--set", "size=40x40", "--set", "out=named"});
  CHECK_MESSAGE(named.code == 0, named.err);
}

TEST_CASE("new refuses a folder of several materials until --name picks one, and synth makes the one that it names") {
  const Workplace w;
  write_picture(w.path / "pack/Concrete07_Color.png", 5);
  write_picture(w.path / "pack/Leather05_Color.png", 7);
  write_picture(w.path / "pack/Leather05_Roughness.png", 3);
  const ProgramRun several = w.run({"new", "pack", "-o", "x.json"});
  CHECK(several.code == 2);
  CHECK_MESSAGE(contains(several.err,
                         "pack holds 2 materials: Concrete07 (base_color); Leather05 (base_color, roughness). --name "
                         "NAME picks one of them; --name '*' takes all files as one material"),
                several.err);
  CHECK(contains(w.run({"library", "add", "one", "pack"}).err, "--set exemplar.name=NAME picks one"));
  CHECK(contains(w.run({"synth", "pack", "-o", "x", "--name", "leather5"}).err, "did you mean \"Leather05\"?"));

  const ProgramRun picked = w.run({"synth", "pack", "-o", "{material}", "--size", "32x32", "--name", "leather05"});
  CHECK_MESSAGE(picked.code == 0, picked.err);
  CHECK(fs::exists(w.path / "Leather05/roughness.png"));
  const ProgramRun one = w.run({"new", "pack", "-o", "one.json", "--name", "concrete07"});
  CHECK_MESSAGE(contains(one.err, "found base_color\n"), one.err);
  CHECK(w.run({"run", "one.json", "--set", "size=32x32"}).code == 0);
  REQUIRE(w.run({"new", "pack", "-o", "wraps.json", "--like", "make_tileable", "--name", "concrete07"}).code == 0);
  CHECK(contains(read_text(w.path / "wraps.json"), "\"name\": \"concrete07\""));
}

TEST_CASE("the stock graph make_tileable keeps the exemplar's size if it is told to, and says how when it does not") {
  const Workplace w;
  write_text(w.path / "tiles.json", R"({"terrazzo": 1, "nodes": {
    "tiles": {"type": "pattern", "kind": "tiles", "size": [64, 64]},
    "cut": {"type": "crop", "material": "@tiles", "size": [61, 53]},
    "files": {"type": "export", "material": "@cut", "path": "tiles/{map}.png"}}})");
  REQUIRE_MESSAGE(w.run({"run", "tiles.json"}).code == 0, w.run({"run", "tiles.json"}).err);
  const auto run = [&](const std::string& fit) {
    return w.run({"run", TERRAZZO_SOURCE_DIR "/graphs/make_tileable.json", "--set", "material=tiles", "--set",
                  "quality=draft", "--set", "fit=" + fit, "--set", "out=" + fit});
  };
  const ProgramRun less = run("repeats"), same = run("size");
  REQUIRE_MESSAGE(less.code == 0, less.err);
  REQUIRE_MESSAGE(same.code == 0, same.err);
  CHECK(read_image_info(w.path / "repeats/base_color.png").size != Size{61, 53});
  CHECK_MESSAGE(contains(less.err, "the exemplar of 61x53 pixels repeats: the result has"), less.err);
  CHECK(contains(less.err, "set \"fit\" to \"size\" to keep 61x53"));
  CHECK(read_image_info(w.path / "size/base_color.png").size == Size{61, 53});
}
