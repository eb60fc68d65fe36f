#include <doctest/doctest.h>

#include "core/image_io/image_file.h"
#include "tests/runner/fakes.h"
#include "tests/runner/program.h"
#include "tests/runner/workplace.h"
#include "tests/texts.h"

/// --interpret, and what commands that only look at an exemplar say of its files.
using namespace terrazzo;
using namespace terrazzo::test;
namespace fs = std::filesystem;

namespace {

void write_map(const fs::path& path, int channels, const std::function<float(int, int, int)>& value) {
  fs::create_directories(path.parent_path());
  write_image(*make_image({32, 24}, channels, value), path, {}, [](double) {});
}

/// A depth map that nothing tells the direction of.
void write_depth(const Workplace& w) {
  write_picture(w.path / "maps/wall_color.png", 5);
  write_map(w.path / "maps/wall_depth.png", 1, [](int x, int y, int) { return float(x * y % 17) / 16; });
}

}  // namespace

TEST_CASE("synth and new take what the user says of a map") {
  const Workplace w;
  write_depth(w);
  const ProgramRun plain = w.run({"synth", "maps", "-o", "plain", "--size", "32x24", "--progress", "plain"});
  CHECK_MESSAGE(plain.code == 0, plain.err);
  CHECK_MESSAGE(contains(plain.err, "--interpret height=inverted) inverts it"), plain.err);
  const ProgramRun said = w.run(
      {"synth", "maps", "-o", "said", "--size", "32x24", "--interpret", "height=inverted", "--progress", "plain"});
  CHECK_MESSAGE(said.code == 0, said.err);
  CHECK_FALSE(contains(said.err, "inverts it"));
  CHECK(read_text(w.path / "plain/height.png") != read_text(w.path / "said/height.png"));

  const ProgramRun made = w.run({"new", "maps", "-o", "wall.json", "--interpret", "height=inverted"});
  CHECK_MESSAGE(made.code == 0, made.err);
  CHECK_MESSAGE(contains(read_text(w.path / "wall.json"), "\"interpret\": {\"height\": \"inverted\"}"),
                read_text(w.path / "wall.json"));
  CHECK(w.run({"check", "wall.json"}).code == 0);
  for (const char* command : {"synth", "new"}) {
    const ProgramRun wrong = w.run({command, "maps", "-o", "wrong", "--interpret", "height=dxt5nm"});
    CHECK(wrong.code == 2);
    CHECK_MESSAGE(contains(wrong.err, "--interpret height=dxt5nm: expected inverted, not_inverted, depth"), wrong.err);
    CHECK(contains(w.run({command, "maps", "-o", "wrong", "--interpret", "hight=inverted"}).err, "expected MAP=HOW"));
    const ProgramRun missing = w.run({command, "maps", "-o", "wrong", "--interpret", "normal=dxt5nm"});
    CHECK(missing.code == 2);
    CHECK_MESSAGE(contains(missing.err, "there is no map \"normal\""), missing.err);
  }
}

TEST_CASE("new and check warn of what synth warns of in an exemplar") {
  const Workplace w;
  write_picture(w.path / "maps/wall_color.png", 5);
  write_map(w.path / "maps/wall_normal.png", 3, [](int x, int y, int c) {
    return c == 2 ? 0.05f + 0.02f * float((x + y) % 3) : 0.45f + 0.01f * float((x * y) % 9);
  });
  fs::create_directory(w.path / "maps/wall_height.png");
  const ProgramRun synth = w.run({"synth", "maps", "-o", "out", "--size", "32x24"});
  const ProgramRun made = w.run({"new", "maps", "-o", "wall.json"});
  const ProgramRun checked = w.run({"check", "wall.json"});
  const ProgramRun json = w.run({"check", "wall.json", "--json"});
  for (const char* warning : {"the normals point into the surface", "wall_height.png is a folder"}) {
    CHECK_MESSAGE(contains(synth.err, warning), synth.err);
    CHECK_MESSAGE(contains(made.err, warning), made.err);
    CHECK_MESSAGE(contains(checked.err, warning), checked.err);
    CHECK_MESSAGE(contains(json.out, warning), json.out);
  }
  CHECK(checked.code == 0);
}

TEST_CASE("check finds what only the pixels of a source show") {
  const Workplace w;
  write_map(w.path / "maps/wall_normal.png", 3, [](int x, int, int) { return float(x) / 32; });
  write_text(w.path / "g.json", R"({"terrazzo": 1, "nodes": {"m": {"type": "load_material", "path": "maps"},
    "e": {"type": "export", "material": "@m", "path": "out/{map}.png"}}})");
  const ProgramRun checked = w.run({"check", "g.json"});
  CHECK(checked.code == 2);
  CHECK_MESSAGE(contains(checked.err, "wall_normal.png: it is grey, and so no normal map"), checked.err);
}

TEST_CASE("an alpha channel is the map that the user says, in place of what it would be taken for") {
  const Workplace w;
  write_map(w.path / "maps/wall_color.png", 4,
            [](int x, int y, int c) { return float((x * 3 + y * 5 + c * 7) % 11) / 10; });
  const std::vector<std::string> plain = {"synth", "maps", "-o", "plain", "--size", "32x24", "--quality", "draft"};
  CHECK(w.run(plain).code == 0);
  CHECK(std::filesystem::exists(w.path / "plain/opacity.png"));
  const ProgramRun said = w.run({"synth", "maps", "-o", "said", "--size", "32x24", "--quality", "draft", "--interpret",
                                 "alpha=height", "--interpret", "height=depth", "--progress", "plain"});
  CHECK_MESSAGE(said.code == 0, said.err);
  CHECK(contains(said.err, "height: wall_color.png (channel a)"));
  CHECK(std::filesystem::exists(w.path / "said/height.png"));
  CHECK_FALSE(std::filesystem::exists(w.path / "said/opacity.png"));
  CHECK(contains(w.run({"synth", "maps", "-o", "x", "--interpret", "alpha=hight"}).err, "did you mean \"height\"?"));
  CHECK(contains(w.run({"synth", "maps", "-o", "x", "--interpret", "alpha=normal"}).err, "a map of one value"));

  write_map(w.path / "maps/wall_normal.png", 4,
            [](int x, int y, int c) { return c == 2 ? 1.f : float((x + y) % 7) / 6; });
  const ProgramRun two = w.run({"synth", "maps", "-o", "x", "--interpret", "alpha=height"});
  CHECK(two.code == 2);
  CHECK_MESSAGE(contains(two.err, "wall_color.png and wall_normal.png have an alpha channel; `maps` says which"),
                two.err);
}
