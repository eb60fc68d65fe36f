#include <cmath>
#include <filesystem>
#include <fstream>

#include <doctest/doctest.h>
#include <fmt/format.h>
#include <unistd.h>

#include "core/base/error.h"
#include "core/exemplar/uv_image.h"
#include "core/image_io/color.h"
#include "core/image_io/image_file.h"
#include "nodes/common/registry.h"
#include "tests/odd_images.h"
#include "tests/run_node.h"
#include "tests/texts.h"

using namespace terrazzo;
using namespace terrazzo::test;
namespace fs = std::filesystem;

namespace {

ImagePtr map_of(Semantic semantic, int channels, Depth depth, const std::string& space = "raw", Size size = {24, 16}) {
  const ImagePtr image = make_image(
      size, channels, [](int x, int y, int c) { return float((x * 9 + y * 4 + c * 31) % 256) / 255.0f; }, semantic);
  ImageInfo info = image->info();
  info.depth = depth;
  info.color_space = space;
  return Image::redescribed(image, info);
}

MaterialPtr bricks() {
  return Material::make("bricks", {{"base_color", map_of(Semantic::base_color, 3, Depth::u8, "srgb_texture")},
                                   {"normal", map_of(Semantic::normal, 3, Depth::u16)},
                                   {"height", map_of(Semantic::height, 1, Depth::f32, "raw", {12, 8})}});
}

NodeRun run(const fs::path& folder, const std::string& pattern, Params params = {}, const MaterialPtr& m = bricks()) {
  params["path"] = (folder / pattern).string();
  return run_node("export", params, {{"material", {m}}});
}

ImagePtr read(const fs::path& path) {
  return read_image(path, {}, [](const std::string& warning) { FAIL_CHECK(warning); });
}

size_t count_files(const fs::path& folder) {
  return size_t(std::distance(fs::recursive_directory_iterator(folder), fs::recursive_directory_iterator()));
}

UvMapPtr some_uv() {
  std::vector<ExemplarPixel> pixels;
  for (int i = 0; i < 20 * 10; i++) pixels.push_back({uint16_t(i * 37 % 300), uint16_t(i * 53 % 200)});
  return UvMap::make({20, 10}, {300, 200}, pixels);
}

}  // namespace

TEST_CASE("every map goes to its own file and comes back with its own values and depth") {
  const TemporaryFolder folder;
  const NodeRun r = run(folder.path(), "out/{material}_{map}_{width}x{height}.tif");
  const std::vector<std::pair<std::string, std::string>> files = {{"base_color", "bricks_base_color_24x16.tif"},
                                                                  {"normal", "bricks_normal_24x16.tif"},
                                                                  {"height", "bricks_height_12x8.tif"}};
  for (const auto& [map, file] : files) {
    INFO(file);
    const ImagePtr back = read(folder.path() / "out" / file), map_image = bricks()->find(map);
    CHECK(back->info().depth == map_image->info().depth);
    const std::vector<float> a = back->pixels(), b = map_image->pixels();
    REQUIRE(a.size() == b.size());
    for (size_t i = 0; i < a.size(); i++) CHECK(std::abs(a[i] - b[i]) <= 0.5f / 65535.0f);
  }
  CHECK(read(folder.path() / "out/bricks_base_color_24x16.tif")->pixels() == bricks()->find("base_color")->pixels());
  CHECK(r.notes.empty());
  CHECK(count_files(folder.path()) == 4);
}

TEST_CASE("a depth the format does not hold becomes the nearest, and a note says if it loses") {
  const TemporaryFolder folder;
  NodeRun r = run(folder.path(), "{map}.png");
  CHECK(read(folder.path() / "base_color.png")->info().depth == Depth::u8);
  CHECK(read(folder.path() / "normal.png")->info().depth == Depth::u16);
  CHECK(read(folder.path() / "height.png")->info().depth == Depth::u16);
  CHECK(r.says("height: float values are written as uint16, the nearest that PNG holds"));
  CHECK(r.notes.size() == 1);

  r = run(folder.path(), "{map}.exr");
  CHECK(read(folder.path() / "base_color.exr")->info().depth == Depth::f16);
  CHECK(read(folder.path() / "normal.exr")->info().depth == Depth::f32);
  CHECK(r.notes.empty());

  r = run(folder.path(), "{map}.jpg");
  CHECK(r.says("normal: uint16 values are written as uint8"));

  run(folder.path(), "{map}.tif", {{"depth", "half"}});
  for (const char* map : {"base_color", "normal", "height"})
    CHECK(read(folder.path() / fmt::format("{}.tif", map))->info().depth == Depth::f16);
}

TEST_CASE("halfs are written as floats in TIFF, which more programs read, unless halfs are asked for") {
  const TemporaryFolder folder;
  const MaterialPtr material = Material::make("m", {{"height", map_of(Semantic::height, 1, Depth::f16)}});
  const NodeRun r = run(folder.path(), "{map}.tif", {}, material);
  CHECK(read(folder.path() / "height.tif")->info().depth == Depth::f32);
  CHECK(read(folder.path() / "height.tif")->pixels() == material->find("height")->pixels());
  CHECK(r.notes.empty());
  run(folder.path(), "{map}.tif", {{"depth", "half"}}, material);
  CHECK(read(folder.path() / "height.tif")->info().depth == Depth::f16);
}

TEST_CASE("colours are converted on request, data never") {
  const TemporaryFolder folder;
  run(folder.path(), "{map}.exr", {{"color_space", "lin_rec709"}, {"depth", "float"}});
  const float encoded = bricks()->find("base_color")->read({3, 2, 1, 1})[0];
  const float linear = read(folder.path() / "base_color.exr")->read({3, 2, 1, 1})[0];
  CHECK(linear == doctest::Approx(std::pow((encoded + 0.055) / 1.055, 2.4)).epsilon(1e-5));
  CHECK(read(folder.path() / "normal.exr")->pixels() == bricks()->find("normal")->pixels());
}

TEST_CASE("kept colours are linear in float files and sRGB in others, data as they are") {
  const TemporaryFolder folder;
  const auto mean = [](const ImagePtr& image) {
    double sum = 0;
    for (const float v : image->pixels()) sum += v;
    return sum / double(image->pixels().size());
  };
  const ImagePtr stored = map_of(Semantic::base_color, 3, Depth::u8, "srgb_texture");
  const double linear_mean = mean(convert_color(stored, "lin_rec709"));
  const auto material = [](const ImagePtr& color) {
    return Material::make("m", {{"base_color", color}, {"roughness", map_of(Semantic::roughness, 1, Depth::u8)}});
  };
  run(folder.path(), "{map}.exr", {}, material(stored));
  CHECK(mean(read(folder.path() / "base_color.exr")) == doctest::Approx(linear_mean).epsilon(0.01));
  CHECK(mean(read(folder.path() / "roughness.exr")) ==
        doctest::Approx(mean(map_of(Semantic::roughness, 1, Depth::u8))).epsilon(0.01));
  const ImagePtr linear = convert_color(stored, "lin_rec709");
  run(folder.path(), "{map}.png", {{"depth", "uint8"}}, material(linear));
  CHECK(mean(read(folder.path() / "base_color.png")) == doctest::Approx(mean(stored)).epsilon(0.01));
}

TEST_CASE("normals are turned to the convention asked for") {
  const TemporaryFolder folder;
  run(folder.path(), "{map}.tif", {{"normal_y", "down"}, {"depth", "float"}});
  const std::vector<float> up = bricks()->find("normal")->read({3, 2, 1, 1});
  const std::vector<float> down = read(folder.path() / "normal.tif")->read({3, 2, 1, 1});
  CHECK(down == std::vector<float>{up[0], 1.0f - up[1], up[2]});
  run(folder.path(), "{map}.tif", {{"normal_y", "up"}, {"depth", "float"}});
  CHECK(read(folder.path() / "normal.tif")->pixels() == bricks()->find("normal")->pixels());
}

TEST_CASE("single maps can be chosen, and then need no {map}") {
  const TemporaryFolder folder;
  run(folder.path(), "h.png", {{"maps", Texts{"height"}}, {"depth", "uint16"}});
  CHECK(fs::exists(folder.path() / "h.png"));
  CHECK(count_files(folder.path()) == 1);
}

TEST_CASE("the uv map is exact in every format") {
  const TemporaryFolder folder;
  const UvMapPtr uv = some_uv();
  for (const std::string name : {"uv.png", "uv.tif", "uv.exr"})
    run_node("export", {{"uv_path", (folder.path() / name).string()}}, {{"uv", {uv}}});
  const std::vector<float> png = read(folder.path() / "uv.png")->pixels();
  const std::vector<float> tif = read(folder.path() / "uv.tif")->pixels();
  const ImagePtr exr = read(folder.path() / "uv.exr");
  CHECK(exr->info().depth == Depth::f32);
  REQUIRE(exr->channels() == 2);
  const std::vector<float> fractions = exr->pixels();
  CHECK(png == tif);
  for (size_t i = 0; i < uv->pixels().size(); i++) {
    const ExemplarPixel p = uv->pixels()[i];
    CHECK(png[i * 3] == float(p.x) / 65535.0f);
    CHECK(png[i * 3 + 1] == float(p.y) / 65535.0f);
    CHECK(int(fractions[i * 2] * 300) == p.x);
    CHECK(int(fractions[i * 2 + 1] * 200) == p.y);
  }
}

TEST_CASE("the uv map lies beside the maps if it is given no name of its own") {
  const TemporaryFolder folder;
  run_node("export", {{"path", (folder.path() / "{map}.png").string()}},
           {{"material", {map_of(Semantic::height, 1, Depth::u8)}}, {"uv", {some_uv()}}});
  CHECK(fs::exists(folder.path() / "uv.png"));
  CHECK(fs::exists(folder.path() / "height.png"));
}

TEST_CASE("a report is written as JSON or CSV, its pictures beside it") {
  const TemporaryFolder folder;
  const ReportPtr report = Report::make(
      "quality", {{"distance", 0.25, "smaller is better"}, {"verdict", std::string("good, \"really\""), ""}},
      {{"worst", map_of(Semantic::data, 3, Depth::u8)}});
  run_node("export", {{"report_path", (folder.path() / "r.json").string()}}, {{"report", {report}}});
  run_node("export", {{"report_path", (folder.path() / "r.csv").string()}}, {{"report", {report}}});
  const Bytes json = read_bytes(folder.path() / "r.json"), csv = read_bytes(folder.path() / "r.csv");
  CHECK(contains(std::string(json.begin(), json.end()), "\"value\": 0.25"));
  CHECK(std::string(csv.begin(), csv.end()) ==
        "name,value,help\ndistance,0.25,smaller is better\nverdict,\"good, \"\"really\"\"\",\n");
  CHECK(read(folder.path() / "r_worst.png")->size() == Size{24, 16});
}

TEST_CASE("clipped values are a warning that says how many and how far, or a note if it is next to nothing") {
  const TemporaryFolder folder;
  const ImagePtr bright = make_image(
      {4, 1}, 1, [](int x, int, int) { return float(x); }, Semantic::emission);
  CHECK(
      run(folder.path(), "{map}.png", {{"depth", "uint16"}}, Material::of(bright))
          .says(
              "warning: emission: 50 % of its values lie outside 0..1 (from 2 to 3) and were clipped by uint16; write "
              "it as .exr"));
  const ImagePtr overshot = make_image(
      {4, 1}, 1, [](int x, int, int) { return float(x) / 2.99f; }, Semantic::emission);
  const NodeRun quiet = run(folder.path(), "{map}.png", {{"depth", "uint16"}}, Material::of(overshot));
  CHECK(quiet.says("emission: 25 % of its values lie outside 0..1"));
  CHECK_FALSE(quiet.says("warning"));
}

TEST_CASE("what cannot be exported is refused, and nothing is left behind") {
  const TemporaryFolder folder;
  const auto in = [&](const char* name) { return (folder.path() / name).string(); };
  const std::map<std::string, std::vector<Value>> material = {{"material", {bricks()}}}, uv = {{"uv", {some_uv()}}};
  CHECK(contains(error_of("export", {{"path", in("{map}.png")}}, {}), "expected a wire"));
  CHECK(contains(error_of("export", {}, material), "path: expected a file name pattern"));
  CHECK(contains(error_of("export", {{"path", in("out.png")}}, material),
                 "there are 3 maps (base_color, normal, height)"));
  CHECK(contains(error_of("export", {{"path", in("{name}.png")}}, material), "unknown placeholder {name}"));
  CHECK(contains(error_of("export", {{"path", in("{map.png")}}, material), "expected a } after every {"));
  CHECK(contains(error_of("export", {{"path", in("{map}.bmp")}}, material), "ends in \".bmp\"; expected .png"));
  CHECK(contains(error_of("export", {{"path", in("{map}.pgn")}}, material), "did you mean \".png\"?"));
  CHECK(contains(error_of("export", {{"path", in("{map}")}}, material), "ends in no extension"));
  CHECK(contains(error_of("export", {{"path", in("{map}.png")}, {"depth", "half"}}, material),
                 "PNG files hold uint8, uint16"));
  CHECK(contains(error_of("export", {{"path", in("{map}.png")}, {"maps", Texts{"hieght"}}}, material),
                 "mean \"height\"?"));
  CHECK(contains(error_of("export", {{"path", in("{map}.png")}, {"color_space", "srbg"}}, material),
                 "no colour space \"srbg\""));
  CHECK(contains(error_of("export", {}, uv), "uv_path: expected a file name"));
  CHECK(contains(error_of("export", {{"uv_path", in("uv.jpg")}}, uv), "JPEG is not"));
  const MaterialPtr two = Material::make(
      "m", {{"uv", map_of(Semantic::data, 1, Depth::u8)}, {"height", map_of(Semantic::height, 1, Depth::u8)}});
  CHECK(contains(error_of("export", {{"path", in("{map}.png")}}, {{"material", {two}}, {"uv", {some_uv()}}}),
                 "uv and uv would both be written"));
  CHECK(count_files(folder.path()) == 0);

  ImageInfo info{.size = {8, 8}, .channels = 1, .depth = Depth::u8};
  const ImagePtr broken =
      Image::computed(info, Digest{}, [](const Rect&, float*) { throw Error("the source is gone"); });
  const MaterialPtr half_broken =
      Material::make("m", {{"height", map_of(Semantic::height, 1, Depth::u8)}, {"data", broken}});
  CHECK(contains(error_of("export", {{"path", in("{map}.png")}}, {{"material", {half_broken}}}), "the source is gone"));
  CHECK(count_files(folder.path()) == 0);
}

TEST_CASE("maps and uv map do not go to one file through a link to its folder either") {
  const TemporaryFolder folder;
  fs::create_directory(folder.path() / "there");
  fs::create_directory_symlink("there", folder.path() / "link");
  const Params params = {{"path", (folder.path() / "there/{map}.png").string()},
                         {"uv_path", (folder.path() / "link/height.png").string()}};
  CHECK(contains(error_of("export", params, {{"material", {bricks()}}, {"uv", {some_uv()}}}),
                 "height and uv would both be written to"));
  CHECK(fs::is_empty(folder.path() / "there"));
}

TEST_CASE("a folder that may not be written is named, not a temporary file in it") {
  if (::geteuid() == 0) {
    MESSAGE("skipped: root may write everywhere");
    return;
  }
  const TemporaryFolder folder;
  fs::permissions(folder.path(), fs::perms::owner_read | fs::perms::owner_exec);
  CHECK(contains(
      error_of("export", {{"path", (folder.path() / "{map}.png").string()}}, {{"material", {bricks()}}}),
      "cannot write into the folder " + folder.path().string() + ": Permission denied; write to another folder"));
  fs::permissions(folder.path(), fs::perms::owner_all);
}

TEST_CASE("wrong parameters are found before anything runs") {
  const NodeType* type = find_node_type("export");
  Params params;
  for (const Param& p : type->params) params[p.name] = *p.fallback;
  const auto problems = [&](const std::string& name, const std::string& value) {
    Params changed = params;
    changed[name] = value;
    return type->check(changed);
  };
  CHECK(problems("path", "/out/{map}.png").empty());
  CHECK(problems("path", "/out/{mpa}.png").size() == 1);
  CHECK(problems("uv_path", "/out/uv.txt").size() == 1);
  CHECK(problems("uv_path", "/out/uv.txt")[0].rfind("\"uv_path\"", 0) == 0);
  CHECK(problems("report_path", "/out/report.xml").size() == 1);
  CHECK(problems("color_space", "srbg")[0].rfind("\"color_space\"", 0) == 0);
}
