#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include <doctest/doctest.h>
#include <fmt/format.h>
#include <unistd.h>

#include "core/base/error.h"
#include "core/image_io/image_file.h"
#include "nodes/common/registry.h"
#include "test_paths.h"
#include "tests/odd_images.h"
#include "tests/run_node.h"
#include "tests/texts.h"

using namespace terrazzo;
using namespace terrazzo::test;
namespace fs = std::filesystem;

namespace {

void write(const fs::path& path, int channels, const std::function<float(int, int, int)>& value, Size size = {32, 32}) {
  const ImagePtr image = make_image(size, channels, value);
  write_image(*image, path, {.format = *format_from(path)}, [](double) {});
}

float ramp(int x, int y, int c) {
  return float((x * 5 + y * 3 + c * 40) % 256) / 255.0f;
}

}  // namespace

TEST_CASE("a folder of maps becomes a material with the folder's name") {
  const TemporaryFolder folder;
  const fs::path bricks = folder.path() / "bricks";
  fs::create_directory(bricks);
  write(bricks / "bricks_color.png", 3, ramp);
  write(bricks / "bricks_height.png", 1, ramp, {16, 8});
  write(bricks / "bricks_normal_gl.png", 3, ramp);
  write(bricks / "bricks_sheet.png", 3, ramp);
  std::ofstream(bricks / "SOURCE.txt") << "from here";
  const NodeRun run = run_node("load_material", {{"path", bricks.string() + "/"}});
  const MaterialPtr m = run.get<Material>("material");
  CHECK(m->name() == "bricks");
  CHECK(m->map_names() == "base_color, normal, height");
  CHECK(m->find("base_color")->info().color_space == "srgb_texture");
  CHECK(m->find("base_color")->info().depth == Depth::u8);
  CHECK(m->find("height")->info().color_space == "raw");
  CHECK(m->find("height")->size() == Size{16, 8});
  CHECK(m->find("normal")->info().semantic == Semantic::normal);
  CHECK(m->find("normal")->info().normal_y == NormalY::up);
  CHECK(run.says("base_color: bricks_color.png"));
  CHECK(run.says("ignored, the name says no map: bricks_sheet.png. `data` keeps them"));
  CHECK_FALSE(run.says("SOURCE"));
}

TEST_CASE("maps smaller than the material are a warning that names them and both sizes, maps of one size are none") {
  const TemporaryFolder folder;
  write(folder.path() / "wall_color.png", 3, ramp, {48, 32});
  write(folder.path() / "wall_roughness.png", 1, ramp, {48, 32});
  const Params params = {{"path", folder.path().string()}};
  CHECK_FALSE(run_node("load_material", params).says("warning"));
  write(folder.path() / "wall_height.png", 1, ramp, {24, 16});
  CHECK(run_node("load_material", params)
            .says("warning: the material has 48x32 pixels, the size of its largest map; height (24x16) is scaled up to "
                  "that. If this is not intended, bring the maps to one size"));
  write(folder.path() / "wall_roughness.png", 1, ramp, {30, 20});
  CHECK(run_node("load_material", params).says("height (24x16), roughness (30x20) are scaled up to that."));
}

TEST_CASE("packed files are split, smoothness is inverted") {
  const TemporaryFolder folder;
  write(folder.path() / "wall_ORM.png", 3, ramp);
  NodeRun run = run_node("load_material", {{"path", folder.path().string()}});
  MaterialPtr m = run.get<Material>("material");
  CHECK(m->map_names() == "roughness, metallic, ambient_occlusion");
  for (const auto& [name, channel] : {std::pair("ambient_occlusion", 0), {"roughness", 1}, {"metallic", 2}}) {
    REQUIRE(m->find(name)->channels() == 1);
    CHECK(m->find(name)->read({3, 4, 1, 1})[0] == ramp(3, 4, channel));
  }

  fs::remove(folder.path() / "wall_ORM.png");
  write(folder.path() / "wall_Smoothness.png", 1, ramp);
  run = run_node("load_material", {{"path", folder.path().string()}});
  CHECK(run.get<Material>("material")->find("roughness")->read({3, 4, 1, 1})[0] == 1.0f - ramp(3, 4, 0));
  CHECK(run.says("roughness is wall_Smoothness.png, inverted"));
}

TEST_CASE("a packed file of equal channels is a warning that says how to read it as one map") {
  const TemporaryFolder folder;
  write(folder.path() / "wall_ORM.png", 3, [](int x, int y, int) { return ramp(x, y, 0); });
  const std::string path = folder.path().string();
  CHECK(run_node("load_material", {{"path", path}})
            .says("warning: wall_ORM.png: roughness, metallic, ambient_occlusion are read from its channels, but these "
                  "are the same: it is a grey picture, not a packed one. If it is one map, say which, and leave the "
                  "others out: `maps` {\"roughness\": \"wall_ORM.png:r\", \"metallic\": \"\", "
                  "\"ambient_occlusion\": \"\"}"));
  const NodeRun one =
      run_node("load_material",
               {{"path", path},
                {"maps", TextMap{{"roughness", "wall_ORM.png:r"}, {"metallic", ""}, {"ambient_occlusion", ""}}}});
  CHECK_FALSE(one.says("warning"));
  write(folder.path() / "wall_ORM.png", 3, ramp);
  CHECK_FALSE(run_node("load_material", {{"path", path}}).says("warning"));
}

TEST_CASE("grey maps stored in colour are reduced, with a warning if the channels differ") {
  const TemporaryFolder folder;
  write(folder.path() / "height.png", 3, [](int x, int y, int) { return ramp(x, y, 0); });
  write(folder.path() / "roughness.png", 3, ramp);
  const NodeRun run = run_node("load_material", {{"path", folder.path().string()}});
  CHECK(run.get<Material>("material")->find("height")->channels() == 1);
  CHECK(run.get<Material>("material")->find("roughness")->channels() == 1);
  CHECK(run.says("warning: roughness.png: its channels differ"));
  CHECK_FALSE(run.says("height.png: its channels differ"));
}

TEST_CASE("a base colour's alpha becomes opacity unless it says nothing") {
  const TemporaryFolder folder;
  write(folder.path() / "albedo.png", 4, [](int x, int y, int c) { return c == 3 ? float(x % 2) : ramp(x, y, c); });
  NodeRun run = run_node("load_material", {{"path", folder.path().string()}});
  CHECK(run.get<Material>("material")->map_names() == "base_color, opacity");
  CHECK(run.get<Material>("material")->find("base_color")->channels() == 3);
  CHECK(run.get<Material>("material")->find("base_color")->read({2, 1, 1, 1})[1] == ramp(2, 1, 1));
  write(folder.path() / "albedo.png", 4, [](int x, int y, int c) { return c == 3 ? 1.0f : ramp(x, y, c); });
  run = run_node("load_material", {{"path", folder.path().string()}});
  CHECK(run.get<Material>("material")->map_names() == "base_color");
}

TEST_CASE("the normal convention comes from the parameter, the name, or the pixels") {
  const TemporaryFolder folder;
  const auto bump = [](int x, int y) { return float(0.5 + 0.25 * std::sin(x * 0.6 + y * 0.2) * std::cos(y * 0.5)); };
  write(folder.path() / "height.png", 1, [&](int x, int y, int) { return bump(x, y); });
  const auto down = [&](int x, int y, int c) {
    return c == 2 ? 1.0f : 0.5f + (c == 0 ? bump(x - 1, y) - bump(x + 1, y) : bump(x, y - 1) - bump(x, y + 1));
  };
  const auto convention = [&](const char* wish) {
    const NodeRun run = run_node("load_material", {{"path", folder.path().string()}, {"normal_y", wish}});
    return run.get<Material>("material")->find("normal")->info().normal_y;
  };
  write(folder.path() / "normal.png", 3, down);
  CHECK(convention("auto") == NormalY::down);
  CHECK(convention("up") == NormalY::up);
  CHECK(run_node("load_material", {{"path", folder.path().string()}}).says("judged by the height map"));
  fs::remove(folder.path() / "height.png");
  CHECK(convention("auto") == NormalY::down);
  fs::rename(folder.path() / "normal.png", folder.path() / "normal_gl.png");
  CHECK(convention("auto") == NormalY::up);
  const NodeRun misnamed = run_node("load_material", {{"path", folder.path().string()}});
  CHECK(misnamed.says("normal_gl.png says that green points up (OpenGL), but it seems to point down"));
  CHECK(misnamed.says("set `normal_y` to \"down\" if it is wrong"));
  fs::rename(folder.path() / "normal_gl.png", folder.path() / "normal_dx.png");
  CHECK(convention("auto") == NormalY::down);
  CHECK_FALSE(run_node("load_material", {{"path", folder.path().string()}}).says("seems to point"));
  fs::remove(folder.path() / "normal_dx.png");
  write(folder.path() / "normal.png", 3, [](int, int, int c) { return c == 2 ? 1.0f : 0.5f; });
  CHECK(run_node("load_material", {{"path", folder.path().string()}}).says("up is assumed"));
}

TEST_CASE("the parameters maps and ignore overrule the names") {
  const TemporaryFolder folder;
  write(folder.path() / "color.png", 3, ramp);
  write(folder.path() / "height_old.png", 1, ramp);
  write(folder.path() / "scan.png", 3, ramp);
  NodeRun run = run_node("load_material", {{"path", folder.path().string()},
                                           {"maps", TextMap{{"height", "scan.png:g"}, {"mask_moss", "color.png:b"}}},
                                           {"ignore", Texts{"*_old.png", "*.jpg"}}});
  const MaterialPtr m = run.get<Material>("material");
  CHECK(m->map_names() == "base_color, height, mask_moss");
  CHECK(m->find("height")->read({5, 6, 1, 1})[0] == ramp(5, 6, 1));
  CHECK(m->find("mask_moss")->info().semantic == Semantic::mask);
  CHECK(run.says("the pattern \"*.jpg\""));

  run = run_node("load_material", {{"path", folder.path().string()}, {"maps", TextMap{{"height", ""}}}});
  CHECK(run.get<Material>("material")->map_names() == "base_color");
  CHECK(
      contains(error_of("load_material", {{"path", folder.path().string()}, {"maps", TextMap{{"height", "scam.png"}}}}),
               "did you mean \"scan.png\"?"));
  CHECK(contains(
      error_of("load_material", {{"path", folder.path().string()}, {"maps", TextMap{{"height", "scan.png:a"}}}}),
      "height should be channel a of scan.png, which has only 3 channels"));
  CHECK(contains(
      error_of("load_material", {{"path", folder.path().string()}, {"maps", TextMap{{"height", "scan.png:red"}}}}),
      "height should be channel red of scan.png, but channels are called r, g, b and a"));
  const NodeType* type = find_node_type("load_material");
  Params params = {{"maps", TextMap{{"hieght", "scan.png"}}}, {"color_space", "auto"}};
  REQUIRE(type->check(params).size() == 1);
  CHECK(contains(type->check(params)[0], "did you mean \"height\"?"));
}

TEST_CASE("a folder of several materials is refused until `name` picks one") {
  const TemporaryFolder folder;
  for (const char* file : {"Concrete07_color.png", "Leather05_color.png", "Leather05_roughness.png"})
    write(folder.path() / file, 3, [](int x, int y, int) { return ramp(x, y, 0); });
  const std::string path = folder.path().string();
  CHECK(
      error_of("load_material", {{"path", path}}) ==
      "path: " + path +
          " holds 2 materials: Concrete07 (base_color); Leather05 (base_color, roughness). The parameter `name` picks "
          "one of them; `\"name\": \"*\"` takes all files as one material");
  CHECK(error_of("load_material", {{"path", path}, {"name", "lether05"}}) ==
        "name: there is no material \"lether05\" in " + path +
            " (did you mean \"Leather05\"?); it holds Concrete07 (base_color); Leather05 (base_color, roughness)");
  const NodeRun run = run_node("load_material", {{"path", path}, {"name", "leather05"}});
  CHECK(run.get<Material>("material")->name() == "Leather05");
  CHECK(run.get<Material>("material")->map_names() == "base_color, roughness");
  CHECK(run.says("left out, other materials: Concrete07"));
  CHECK(run_node("load_material", {{"path", path}, {"name", "*"}}).says("Concrete07_color.png (32x32) left out"));
}

TEST_CASE("ID maps and files kept as data come in as they are") {
  const TemporaryFolder folder;
  for (const char* file : {"wall_color.png", "wall_ID.png", "wall_fuzz.png"}) write(folder.path() / file, 3, ramp);
  const NodeRun run =
      run_node("load_material", {{"path", folder.path().string()}, {"data", Texts{"*fuzz*", "*gone*"}}});
  const MaterialPtr m = run.get<Material>("material");
  CHECK(m->map_names() == "base_color, data_fuzz, data_id");
  CHECK(m->find("data_id")->info().semantic == Semantic::data);
  CHECK(m->find("data_id")->channels() == 3);
  CHECK(m->find("data_fuzz")->info().color_space == "raw");
  CHECK(run.says("the pattern \"*gone*\" of the parameter `data` keeps no file"));
}

TEST_CASE("a folder that gives no material is refused with what was found") {
  const TemporaryFolder folder;
  fs::create_directory(folder.path() / "bricks");
  CHECK(
      contains(error_of("load_material", {{"path", (folder.path() / "brick").string()}}), "did you mean \"bricks\"?"));
  CHECK(contains(error_of("load_material", {{"path", (folder.path() / "bricks").string()}}), "the folder is empty"));
  std::ofstream(folder.path() / "bricks" / "readme.md") << "x";
  write(folder.path() / "bricks" / "photo.png", 3, ramp);
  CHECK(contains(error_of("load_material", {{"path", (folder.path() / "bricks").string()}}),
                 "it holds photo.png, readme.md"));
  CHECK(contains(error_of("load_material", {{"path", (folder.path() / "bricks" / "readme.md").string()}}),
                 "expected a folder with the material's maps, or a picture, found the file"));
  CHECK(run_node("load_material", {{"path", (folder.path() / "bricks" / "photo.png").string()}})
            .get<Material>("material")
            ->map_names() == "base_color");
  write(folder.path() / "bricks" / "color.png", 3, ramp);
  CHECK(contains(error_of("load_material", {{"path", (folder.path() / "bricks").string()}, {"color_space", "srbg"}}),
                 "there is no colour space \"srbg\""));
  write_bytes(folder.path() / "bricks" / "height.png", {1, 2, 3});
  CHECK(contains(error_of("load_material", {{"path", (folder.path() / "bricks").string()}}), "height.png"));
}

TEST_CASE("a link to a missing file is an error, not a material without that map") {
  const TemporaryFolder folder;
  write(folder.path() / "height.png", 1, ramp);
  fs::create_symlink("gone.png", folder.path() / "color.png");
  CHECK(contains(error_of("load_material", {{"path", folder.path().string()}}),
                 "color.png: it is a link to gone.png, which does not"));
}

TEST_CASE("a folder that cannot be read is not called empty or missing") {
  const TemporaryFolder folder;
  fs::create_symlink("loop", folder.path() / "loop");
  CHECK(contains(error_of("load_material", {{"path", (folder.path() / "loop").string()}}),
                 "loop: Too many levels of symbolic links"));
  if (::geteuid() == 0) {
    MESSAGE("skipped the rest: root may read everything");
    return;
  }
  fs::create_directory(folder.path() / "locked");
  fs::permissions(folder.path() / "locked", fs::perms::none);
  CHECK(contains(error_of("load_material", {{"path", (folder.path() / "locked").string()}}),
                 "locked: Permission denied"));
}

TEST_CASE("the files read are the folder's images and those given, sorted") {
  const TemporaryFolder folder;
  for (const char* name : {"b_color.png", "a_height.png", "unknown.jpg", "SOURCE.txt"})
    std::ofstream(folder.path() / name) << "x";
  const NodeType* type = find_node_type("load_material");
  const std::vector<fs::path> files =
      type->files_read({{"path", folder.path().string()}, {"maps", TextMap{{"normal", "../n.png:rgb"}}}});
  CHECK(files == std::vector<fs::path>{folder.path() / "../n.png", folder.path() / "a_height.png",
                                       folder.path() / "b_color.png", folder.path() / "unknown.jpg"});
}

TEST_CASE("the exemplars are recognised, each normal map with the convention that fits its height") {
  const char* given = std::getenv("TERRAZZO_EXEMPLARS");
  const fs::path folder = given ? given : fs::path(TERRAZZO_SOURCE_DIR) / "../shared/exemplars";
  if (!fs::is_directory(folder)) {
    MESSAGE("skipped: no exemplars in ", folder.string(), " (set TERRAZZO_EXEMPLARS)");
    return;
  }
  for (const fs::directory_entry& e : fs::directory_iterator(folder)) {
    INFO(e.path().string());
    const NodeRun run = run_node("load_material", {{"path", e.path().string()}});
    const MaterialPtr m = run.get<Material>("material");
    CHECK(m->find(Semantic::base_color));
    size_t images = 0;
    for (const fs::directory_entry& f : fs::directory_iterator(e)) images += looks_like_image(f.path());
    CHECK(m->maps().size() == images);
    std::ifstream source(e.path() / "SOURCE.txt");
    const std::string text((std::istreambuf_iterator<char>(source)), std::istreambuf_iterator<char>());
    if (m->find("normal") && text.find("Y up): DX") != std::string::npos)
      CHECK(m->find("normal")->info().normal_y == NormalY::down);
    if (m->find("normal") && text.find("Y up): GL") != std::string::npos)
      CHECK(m->find("normal")->info().normal_y == NormalY::up);
  }
}

TEST_CASE("a window that all layers of a file have is told once of a material") {
  const TemporaryFolder folder;
  std::vector<float> pixels(108, 0.5f);
  for (size_t i = 2; i < pixels.size(); i += 3) pixels[i] = 1;
  write_odd(folder.path() / "wall.exr",
            {.size = {6, 6},
             .channels = 3,
             .type = "half",
             .display = {1, 1, 4, 4},
             .images = 2,
             .part_names = {"albedo", "normal"}},
            pixels);
  const NodeRun run = run_node("load_material", {{"path", folder.path().string()}});
  CHECK(std::ranges::count_if(run.notes, [](const std::string& n) { return contains(n, "data window"); }) == 1);
}

TEST_CASE("pictures of rarer formats are maps, and those of formats that are not read are warned of") {
  const TemporaryFolder folder;
  const std::string pixels = "P6\n2 1\n255\n\x33\x66\x99\xff\xff\xff";
  write_bytes(folder.path() / "wall_color.ppm", Bytes(pixels.begin(), pixels.end()));
  std::ofstream(folder.path() / "wall_height.kra") << "PK";
  std::ofstream(folder.path() / "sketch.kra") << "PK";
  const NodeRun run = run_node("load_material", {{"path", folder.path().string()}});
  CHECK(run.get<Material>("material")->find("base_color")->read({0, 0, 1, 1}) == std::vector<float>{0.2f, 0.4f, 0.6f});
  CHECK(
      run.says("warning: wall_height.kra is left out: .kra is not read. If it is to be height, save it as PNG, TIFF or "
               "EXR"));
  CHECK_FALSE(run.says("sketch"));
  fs::remove(folder.path() / "wall_color.ppm");
  const std::string error = error_of("load_material", {{"path", folder.path().string()}});
  CHECK(contains(error, "wall_height.kra would be a map by its name, but .kra files are not read as images"));
  CHECK_FALSE(contains(error, "sketch.kra would"));
  CHECK(contains(error, "`terrazzo nodes load_material` has them all"));
}
