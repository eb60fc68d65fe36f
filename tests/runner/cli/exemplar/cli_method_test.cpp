#include <doctest/doctest.h>

#include "core/base/hash.h"
#include "core/image_io/image_file.h"
#include "tests/exemplars.h"
#include "tests/runner/fakes.h"
#include "tests/runner/program.h"
#include "tests/runner/workplace.h"

/// `synth --method` and what `new` says of the two ways.
using namespace terrazzo;
using namespace terrazzo::test;
namespace fs = std::filesystem;

namespace {

/// Grain without structure; with scratches: lines that stand out.
void write_grain(const fs::path& path, bool scratched) {
  fs::create_directories(path.parent_path());
  const auto value = [&](int x, int y, int) {
    for (int i = 0; scratched && i < 12; i++)
      if (random_bits(9, x - i, y) % 300 == 0) return 1.0f;
    double sum = 0;
    for (int dy = 0; dy < 4; dy++)
      for (int dx = 0; dx < 4; dx++) sum += unit_double(random_bits(7, x + dx, y + dy));
    return float(0.2 + 0.4 * sum / 16);
  };
  const ImagePtr image = make_image({96, 96}, 3, value, Semantic::base_color, "srgb_texture");
  write_image(*image, path, {.format = FileFormat::png, .depth = Depth::u8}, [](double) {});
}

struct Exemplars : Workplace {
  Exemplars() {
    write_grain(path / "sand/base_color.png", false);
    write_grain(path / "rough/base_color.png", true);
  }
  ProgramRun synth(const std::string& exemplar, const std::string& out, std::vector<std::string> more) const {
    std::vector<std::string> args = {"synth", exemplar, "-o", out, "--size", "100x80"};
    args.insert(args.end(), more.begin(), more.end());
    return run(args);
  }
  std::string map(const std::string& out) const { return read_text(path / out / "base_color.png"); }
};

}  // namespace

TEST_CASE("synth makes noise by example if it is told to, of any size, which may wrap") {
  const Exemplars w;
  const ProgramRun noise = w.synth("sand", "noise", {"--method", "noise", "--seed", "3", "--tileable"});
  CHECK_MESSAGE(noise.code == 0, noise.err);
  CHECK(read_image_info(w.path / "noise/base_color.png").size == Size{100, 80});
  CHECK(w.synth("sand", "other", {"--method", "noise", "--seed", "4", "--tileable"}).code == 0);
  CHECK(w.map("other") != w.map("noise"));
  CHECK(w.synth("sand", "free", {"--method", "noise", "--seed", "3"}).code == 0);
  CHECK(w.map("free") != w.map("noise"));
}

TEST_CASE("synth makes a layout unless told otherwise; auto takes what suits the exemplar and says why") {
  const Exemplars w;
  REQUIRE(w.synth("sand", "unset", {}).code == 0);
  REQUIRE(w.synth("sand", "layout", {"--method", "layout"}).code == 0);
  REQUIRE(w.synth("sand", "noise", {"--method", "noise"}).code == 0);
  CHECK(w.map("unset") == w.map("layout"));
  CHECK(w.map("unset") != w.map("noise"));

  const ProgramRun sand = w.synth("sand", "auto", {"--method", "auto"});
  REQUIRE_MESSAGE(sand.code == 0, sand.err);
  CHECK_MESSAGE(contains(sand.err, "noise by example suits it: it has no lattice"), sand.err);
  CHECK(w.map("auto") == w.map("noise"));

  REQUIRE(w.synth("rough", "laid", {}).code == 0);
  const ProgramRun rough = w.synth("rough", "auto", {"--method", "auto"});
  REQUIRE_MESSAGE(rough.code == 0, rough.err);
  CHECK_MESSAGE(contains(rough.err, "a layout suits it: its features stand out"), rough.err);
  CHECK(w.map("auto") == w.map("laid"));
}

TEST_CASE("options of a layout are refused with noise, and settle the matter with auto") {
  const Exemplars w;
  for (const std::vector<std::string>& option :
       {std::vector<std::string>{"--quality", "draft"}, {"--blend", "2"}, {"--join", "0"}}) {
    const ProgramRun refused = w.synth("sand", "x", {"--method", "noise", option[0], option[1]});
    CHECK(refused.code == 2);
    CHECK_MESSAGE(contains(refused.err, option[0] + ": noise by example has no layout"), refused.err);
    const ProgramRun laid = w.synth("sand", "laid", {"--method", "auto", option[0], option[1]});
    CHECK_MESSAGE(laid.code == 0, laid.err);
    CHECK_MESSAGE(contains(laid.err, "a layout is made: " + option[0] + " asks for one"), laid.err);
  }
  CHECK_FALSE(fs::exists(w.path / "x"));
}

TEST_CASE("a method that there is not, auto without looking, and auto of nothing are errors") {
  const Exemplars w;
  CHECK(w.synth("sand", "x", {"--method", "best"}).code == 2);
  const ProgramRun dry = w.synth("sand", "x", {"--method", "auto", "--dry-run"});
  CHECK(dry.code == 2);
  CHECK_MESSAGE(contains(dry.err, "--method auto: it has to look at the exemplar"), dry.err);
  const ProgramRun missing = w.synth("nothing", "x", {"--method", "auto"});
  CHECK(missing.code == 2);
  CHECK_MESSAGE(contains(missing.err, "error: FOLDER: there is no folder or picture "), missing.err);
  CHECK_FALSE(fs::exists(w.path / "x"));
}

TEST_CASE("new says which way suits the maps, in a comment too, and begins with it if asked") {
  const Exemplars w;
  const ProgramRun sand = w.run({"new", "sand", "-o", "sand.json"});
  REQUIRE_MESSAGE(sand.code == 0, sand.err);
  CHECK_MESSAGE(contains(sand.err, "noise by example suits it: "), sand.err);
  CHECK(contains(sand.err, "--like noise begins with that"));
  CHECK(contains(read_text(w.path / "sand.json"), "noise by example suits it: "));
  const ProgramRun rough = w.run({"new", "rough", "-o", "rough.json"});
  CHECK_MESSAGE(contains(rough.err, "a layout suits it: its features stand out"), rough.err);

  REQUIRE(w.run({"new", "sand", "-o", "noise.json", "--like", "noise"}).code == 0);
  CHECK(contains(read_text(w.path / "noise.json"), "noise_by_example"));
  const ProgramRun run = w.run({"run", "noise.json", "--set", "size=64x64", "--set", "out=made"});
  CHECK_MESSAGE(run.code == 0, run.err);
}

TEST_CASE("new says that brushed metal has streaks, which its graph finds again") {
  const Workplace w;
  fs::create_directories(w.path / "metal");
  write_image(*brushed({192, 160}), w.path / "metal/base_color.png", {.format = FileFormat::png, .depth = Depth::u8},
              [](double) {});
  const ProgramRun looked = w.run({"new", "metal", "-o", "metal.json"});
  REQUIRE_MESSAGE(looked.code == 0, looked.err);
  CHECK_MESSAGE(contains(looked.err, "streaks; it does not tile"), looked.err);
  CHECK_MESSAGE(contains(looked.err, "a layout suits it: it has streaks"), looked.err);
  CHECK(contains(read_text(w.path / "metal.json"), "streaks along x, of which synthesis sees one in 4 pixels"));
  const ProgramRun run = w.run({"run", "metal.json", "--set", "size=300x200", "--set", "out=made"});
  REQUIRE_MESSAGE(run.code == 0, run.err);
  CHECK_MESSAGE(contains(run.err, "streaks along x"), run.err);
  CHECK(read_image_info(w.path / "made/base_color.png").size == Size{300, 200});
}
