#include <algorithm>
#include <functional>

#include <doctest/doctest.h>

#include "core/image_io/image_file.h"
#include "test_paths.h"
#include "tests/runner/program.h"
#include "tests/runner/workplace.h"

/// The stock graphs that steer synthesis do what they are for.
using namespace terrazzo;
using namespace terrazzo::test;
namespace fs = std::filesystem;

namespace {

void write_grey(const fs::path& path, Size size, const std::function<double(int, int)>& value) {
  fs::create_directories(path.parent_path());
  const ImagePtr image = make_image(
      size, 3, [&](int x, int y, int) { return float(value(x, y)); }, Semantic::base_color, "srgb_texture");
  write_image(*image, path, {.format = FileFormat::png, .depth = Depth::u8}, [](double) {});
}

double grain(int x, int y) {
  return 0.2 * unit_double(random_bits(3, x, y));
}

/// Dark on the left, light on the right.
void write_two_tones(const fs::path& path) {
  write_grey(path, {64, 48}, [](int x, int y) { return (x < 32 ? 0.1 : 0.7) + grain(x, y); });
}

/// What `size`, 60x40, results of a graph show: whether a pixel is light.
std::vector<bool> light_pixels(const Workplace& w, const std::string& graph, std::vector<std::string> settings) {
  std::vector<std::string> args = {
      "run", TERRAZZO_SOURCE_DIR "/graphs/" + graph + ".json", "--set", "size=60x40", "--set", "out=" + graph};
  for (const std::string& s : settings) args.insert(args.end(), {"--set", s});
  const ProgramRun run = w.run(args);
  REQUIRE_MESSAGE(run.code == 0, run.err);
  const ImagePtr image = read_image(w.path / graph / "base_color.png", ImageInfo{}, [](const std::string&) {});
  REQUIRE(image->size() == Size{60, 40});
  const std::vector<float> pixels = image->pixels();
  std::vector<bool> light;
  for (size_t i = 0; i < pixels.size(); i += 3) light.push_back(pixels[i] > 0.5f);
  return light;
}

/// The part of light pixels in columns [from, to).
double light_part(const std::vector<bool>& light, int from, int to) {
  int count = 0;
  for (int y = 0; y < 40; y++)
    for (int x = from; x < to; x++) count += light[size_t(y) * 60 + x];
  return count / (40.0 * (to - from));
}

/// White from the middle of the result on.
void write_halves(const fs::path& path) {
  write_grey(path, {60, 40}, [](int x, int) { return x < 30 ? 0.0 : 1.0; });
}

}  // namespace

TEST_CASE("mix shows the second material where the mix map is white") {
  const Workplace w;
  write_grey(w.path / "dark/basecolor.png", {48, 48}, [](int x, int y) { return 0.1 + grain(x, y); });
  write_grey(w.path / "light/basecolor.png", {40, 56}, [](int x, int y) { return 0.7 + grain(x, y); });
  write_halves(w.path / "map.png");
  const std::vector<bool> light = light_pixels(w, "mix", {"first=dark", "second=light", "mix=map.png"});
  CHECK(light_part(light, 0, 27) < 0.02);
  CHECK(light_part(light, 33, 60) > 0.98);
}

TEST_CASE("mix fades one material into the other, or says what comparing heights needs") {
  const Workplace w;
  write_grey(w.path / "dark/basecolor.png", {48, 48}, [](int x, int y) { return 0.1 + grain(x, y); });
  write_grey(w.path / "light/basecolor.png", {40, 56}, [](int x, int y) { return 0.7 + grain(x, y); });
  write_halves(w.path / "map.png");
  const std::vector<std::string> settings = {"first=dark", "second=light", "mix=map.png", "width=20"};
  std::vector<std::string> soft = settings;
  soft.emplace_back("border=soft");
  const std::vector<bool> light = light_pixels(w, "mix", soft);
  CHECK(light_part(light, 0, 20) == 0);
  CHECK(light_part(light, 40, 60) == 1);
  const ImagePtr image = read_image(w.path / "mix/base_color.png", ImageInfo{}, [](const std::string&) {});
  const auto mean_of = [&](int x) {
    double sum = 0;
    for (const float v : image->read({x, 0, 1, 40})) sum += double(v);
    return sum / 120;
  };
  for (int x = 21; x < 37; x++) CHECK(mean_of(x) < mean_of(x + 2) + 0.03);  // up, but for the grain
  CHECK(mean_of(29) > mean_of(20) + 0.2);
  CHECK(mean_of(29) < mean_of(40) - 0.1);
  std::vector<std::string> args = {"run", TERRAZZO_SOURCE_DIR "/graphs/mix.json", "--set", "size=60x40"};
  for (const std::string& s : settings) args.insert(args.end(), {"--set", s});
  args.insert(args.end(), {"--set", "border=height"});
  const ProgramRun run = w.run(args);
  CHECK(run.code != 0);
  CHECK(run.err.find("height compares height maps, and material 1 has only base_color") != std::string::npos);
}

TEST_CASE("labels lays the exemplar's parts out as painted") {
  const Workplace w;
  write_two_tones(w.path / "stone/basecolor.png");
  write_grey(w.path / "parts.png", {64, 48}, [](int x, int) { return x < 32 ? 0.9 : 0.3; });
  write_grey(w.path / "layout.png", {60, 40}, [](int x, int) { return x < 30 ? 0.3 : 0.9; });
  const std::vector<bool> light =
      light_pixels(w, "labels", {"material=stone", "labels=parts.png", "target=layout.png"});
  CHECK(light_part(light, 0, 27) > 0.98);
  CHECK(light_part(light, 33, 60) < 0.02);
  write_grey(w.path / "other.png", {60, 40}, [](int x, int) { return x < 45 ? 0.3 : 0.6; });
  const auto warns = [&](const std::string& layout) {
    const ProgramRun run =
        w.run({"run", TERRAZZO_SOURCE_DIR "/graphs/labels.json", "--set", "size=20x20", "--set", "out=other", "--set",
               "material=stone", "--set", "labels=parts.png", "--set", "target=" + layout});
    REQUIRE_MESSAGE(run.code == 0, run.err);
    return run.err.find("25 % of the target have values missing in \"exemplar_control\"") != std::string::npos;
  };
  CHECK(warns("other.png"));
  CHECK_FALSE(warns("layout.png"));
}

TEST_CASE("progression goes from one end of the exemplar to the other, either way") {
  const Workplace w;
  write_two_tones(w.path / "stone/basecolor.png");
  write_halves(w.path / "map.png");
  const auto run = [&](const std::string& inverted) {
    return light_pixels(w, "progression", {"material=stone", "target=map.png", "strength=4", "inverted=" + inverted});
  };
  const std::vector<bool> light = run("false"), other = run("true");
  CHECK(light_part(light, 0, 24) < 0.1);
  CHECK(light_part(light, 36, 60) > 0.9);
  CHECK(light_part(other, 0, 24) > 0.9);
  CHECK(light_part(other, 36, 60) < 0.1);
}

TEST_CASE("inpaint keeps what tiles tiling where holes lie on the border, unless it is told not to") {
  const Workplace w;
  // Gravel that repeats after 64 pixels, white where it is harmed.
  const auto gravel = [](int x, int y) {
    double sum = 0;
    for (int dy = 0; dy < 4; dy++)
      for (int dx = 0; dx < 4; dx++) sum += unit_double(random_bits(6, (x + dx) % 64, (y + dy) % 64)) / 16;
    return sum;
  };
  const auto is_harmed = [](int x, int y) { return (x < 9 || x > 56) && y > 20 && y < 40; };
  write_grey(w.path / "stones/base_color.png", {64, 64},
             [&](int x, int y) { return is_harmed(x, y) ? 1.0 : gravel(x, y); });
  write_grey(w.path / "holes.png", {64, 64}, [&](int x, int y) { return is_harmed(x, y) ? 1.0 : 0.0; });
  // The mean step across the left and right border, where the hole is, as a multiple of that inside.
  const auto step = [&](const std::vector<std::string>& settings) {
    std::vector<std::string> args = {"run",   TERRAZZO_SOURCE_DIR "/graphs/inpaint.json",
                                     "--set", "material=stones",
                                     "--set", "mask=holes.png",
                                     "--set", "margin=0",
                                     "--set", "out=out"};
    for (const std::string& s : settings) args.insert(args.end(), {"--set", s});
    const ProgramRun run = w.run(args);
    REQUIRE_MESSAGE(run.code == 0, run.err);
    CHECK((run.err.find("the exemplar tiles, and so does the result") != std::string::npos) == settings.empty());
    const ImagePtr image = read_image(w.path / "out/base_color.png", ImageInfo{}, [](const std::string&) {});
    const std::vector<float> p = image->pixels();
    double seam = 0, inside = 0;
    for (int y = 22; y < 39; y++) {
      seam += std::abs(p[size_t(y) * 192] - p[size_t(y) * 192 + 189]) / 17;
      for (int x = 0; x < 63; x++)
        inside += std::abs(p[size_t(y * 64 + x) * 3] - p[size_t(y * 64 + x + 1) * 3]) / (17 * 63);
    }
    return seam / inside;
  };
  CHECK(step({}) < 1.8);
  CHECK(step({"tileable=none"}) > step({}));
}

TEST_CASE("masked never shows what must not be shown") {
  const Workplace w;
  write_two_tones(w.path / "stone/basecolor.png");
  write_grey(w.path / "mask.png", {64, 48}, [](int x, int) { return x < 32 ? 1.0 : 0.0; });
  CHECK(light_part(light_pixels(w, "masked", {"material=stone", "mask=mask.png"}), 0, 60) == 0);
}

TEST_CASE("variants shows turned copies of the exemplar") {
  const Workplace w;
  write_grey(w.path / "stone/basecolor.png", {48, 48}, [](int, int y) { return y / 6 % 2 == 0 ? 0.2 : 0.8; });
  const auto standing = [&](const std::string& rotations) {
    const std::vector<bool> light = light_pixels(w, "variants", {"material=stone", "rotations=" + rotations});
    int count = 0;
    for (size_t i = 0; i + 1 < light.size(); i++) count += i % 60 < 59 && light[i] != light[i + 1];
    return count;
  };
  const int lying = standing("[]"), both = standing("[90]");
  CAPTURE(lying);
  CHECK(both > 2 * lying);
}

namespace {

/// Tiles of 12 pixels with light joints, whose first is `first` pixels from the border.
void write_tiles(const fs::path& path, int first, double shade) {
  write_grey(path, {72, 60}, [=](int x, int y) {
    return wrap(x - first, 12) < 2 || wrap(y - first, 12) < 2 ? 0.9 : shade + grain(x, y);
  });
}

/// The part of pixels in columns [from, to) that are light just where joints of 12-pixel tiles would be.
double tiled_part(const std::vector<bool>& light, int from, int to) {
  int most = 0;
  for (int left = 0; left < 12; left++)
    for (int top = 0; top < 12; top++) {
      int count = 0;
      for (int y = 0; y < 40; y++)
        for (int x = from; x < to; x++)
          count += light[size_t(y) * 60 + size_t(x)] == (wrap(x - left, 12) < 2 || wrap(y - top, 12) < 2);
      most = std::max(most, count);
    }
  return most / (40.0 * (to - from));
}

}  // namespace

TEST_CASE("tiles keep their grid where turned copies, other exemplars and other materials meet") {
  const Workplace w;
  write_tiles(w.path / "some/basecolor.png", 0, 0.1);
  write_tiles(w.path / "others/basecolor.png", 5, 0.15);
  write_halves(w.path / "map.png");
  CHECK(tiled_part(light_pixels(w, "variants", {"material=some"}), 0, 60) > 0.98);
  CHECK(tiled_part(light_pixels(w, "several", {"first=some", "second=others"}), 0, 60) > 0.98);
  for (const std::string seed : {"1", "2", "3", "4", "5", "6"}) {
    CAPTURE(seed);
    const auto light = light_pixels(w, "mix", {"first=some", "second=others", "mix=map.png", "seed=" + seed});
    CHECK(tiled_part(light, 0, 60) > 0.98);
  }
  write_grey(w.path / "sand/basecolor.png", {48, 48}, [](int x, int y) { return 0.1 + grain(x, y); });
  const std::vector<bool> light = light_pixels(w, "mix", {"first=some", "second=sand", "mix=map.png"});
  CHECK(tiled_part(light, 0, 29) > 0.95);
  CHECK(light_part(light, 33, 60) < 0.02);
}

TEST_CASE("with leeway a mix ends where tiles do") {
  const Workplace w;
  write_tiles(w.path / "some/basecolor.png", 0, 0.1);
  write_grey(w.path / "sand/basecolor.png", {48, 48}, [](int x, int y) { return 0.5 + grain(x, y); });
  write_grey(w.path / "map.png", {60, 40}, [](int x, int) { return x < 33 ? 0.0 : 1.0; });
  /// The part of the rows in which the sand begins beside a joint or in its place.
  const auto ends_at_joints = [&](const std::string& leeway) {
    light_pixels(w, "mix", {"first=some", "second=sand", "mix=map.png", "leeway=" + leeway});
    const ImagePtr image = read_image(w.path / "mix/base_color.png", ImageInfo{}, [](const std::string&) {});
    const std::vector<float> pixels = image->pixels();
    const auto is_sand = [&](int x, int y) {
      const float v = pixels[size_t(y * 60 + x) * 3];
      return v > 0.4f && v < 0.8f;
    };
    int joints = 0;
    for (int y = 0; y < 40; y++) {
      int x = 59;
      while (x > 0 && is_sand(x, y)) x--;
      const auto is_joint = [&](int at) { return at >= 0 && pixels[size_t(y * 60 + at) * 3] > 0.8f; };
      joints += is_joint(x) || is_joint(x + 1 - 12);
    }
    return joints / 40.0;
  };
  CHECK(ends_at_joints("0") < 0.5);
  CHECK(ends_at_joints("10") > 0.8);
}

TEST_CASE("a mix map that shows one material only is warned of") {
  const Workplace w;
  write_grey(w.path / "sand/basecolor.png", {48, 48}, grain);
  write_grey(w.path / "map.png", {60, 40}, [](int, int) { return 0.4; });
  const ProgramRun run = w.run({"run", TERRAZZO_SOURCE_DIR "/graphs/mix.json", "--set", "size=20x20", "--set", "out=x",
                                "--set", "first=sand", "--set", "second=sand", "--set", "mix=map.png"});
  REQUIRE_MESSAGE(run.code == 0, run.err);
  CHECK(run.err.find("the target has only one of the 2 labels") != std::string::npos);
}

TEST_CASE("several shows parts of both its materials") {
  const Workplace w;
  write_grey(w.path / "dark/basecolor.png", {48, 48}, [](int x, int y) { return 0.1 + grain(x, y); });
  write_grey(w.path / "light/basecolor.png", {40, 56}, [](int x, int y) { return 0.7 + grain(x, y); });
  const double part = light_part(light_pixels(w, "several", {"first=dark", "second=light"}), 0, 60);
  CHECK(part > 0.2);
  CHECK(part < 0.8);
}

TEST_CASE("from_analysis gives what material gives, to the bit") {
  const Workplace w;
  write_two_tones(w.path / "stone/basecolor.png");
  const ProgramRun run = w.run(
      {"run", TERRAZZO_SOURCE_DIR "/graphs/analyse.json", "--set", "material=stone", "--set", "out=stone.analysis"});
  REQUIRE_MESSAGE(run.code == 0, run.err);
  CHECK(light_pixels(w, "from_analysis", {"material=stone", "analysis=stone.analysis"}) ==
        light_pixels(w, "material", {"material=stone"}));
  const auto bytes = [&](const std::string& graph) {
    return read_image(w.path / graph / "base_color.png", ImageInfo{}, [](const std::string&) {})->pixels();
  };
  CHECK(bytes("from_analysis") == bytes("material"));
}
