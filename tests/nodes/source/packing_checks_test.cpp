#include "nodes/source/packing_checks.h"

#include <algorithm>
#include <filesystem>

#include <doctest/doctest.h>

#include "core/image/image_file.h"
#include "nodes/common/registry.h"
#include "tests/odd_images.h"
#include "tests/run_node.h"
#include "tests/texts.h"

using namespace terrazzo;
using namespace terrazzo::test;
namespace fs = std::filesystem;

namespace {

using Value = std::function<float(int, int, int)>;

void write(const fs::path& path, int channels, const Value& value, Size size = {32, 32}) {
  write_image(*make_image(size, channels, value), path, {.format = *format_from(path)}, [](double) {});
}

float ramp(int x, int y, int c) {
  return float((x * 5 + y * 3 + c * 40) % 256) / 255.0f;
}

NodeRun load(const TemporaryFolder& folder, const TextMap& maps = {}) {
  return run_node("load_material", {{"path", folder.path().string()}, {"maps", maps}});
}

std::string names(const NodeRun& run) {
  return run.get<Material>("material")->map_names();
}

float first_of(const NodeRun& run, const char* map) {
  return run.get<Material>("material")->find(map)->read({0, 0, 1, 1})[0];
}

MaterialPtr bricks(int seed) {
  return run_node("pattern", {{"size", Size{128, 128}}, {"seed", int64_t{seed}}}).get<Material>("material");
}

/// A normal map with that alpha.
void write_normals(const fs::path& path, const Image& normals, const Image& alpha) {
  const std::vector<float> xyz = normals.pixels(), a = alpha.pixels();
  write(
      path, 4,
      [&](int x, int y, int c) {
        const size_t i = size_t(y) * size_t(normals.width()) + size_t(x);
        return c == 3 ? a[i] : xyz[i * 3 + size_t(c)];
      },
      normals.size());
}

}  // namespace

TEST_CASE("named channels of an EXR file become the maps that they name, in any order") {
  const TemporaryFolder folder;
  const auto write_channels = [&](const char* file, const std::vector<std::string>& channels,
                                  const std::vector<float>& pixel) {
    write_odd(folder.path() / file,
              {.size = {1, 1}, .channels = int(channels.size()), .type = "float", .channel_names = channels}, pixel);
  };
  write_channels("wall_arm.exr", {"AO", "Metallic", "Roughness"}, {0.9f, 0.05f, 0.5f});
  NodeRun run = load(folder);
  CHECK(names(run) == "roughness, metallic, ambient_occlusion");
  CHECK(first_of(run, "ambient_occlusion") == 0.9f);
  CHECK(first_of(run, "metallic") == 0.05f);
  CHECK(first_of(run, "roughness") == 0.5f);
  fs::remove(folder.path() / "wall_arm.exr");

  write_channels("wall.exr", {"Z", "albedo.B", "albedo.G", "albedo.R", "height", "roughness"},
                 {57, 0.1f, 0.2f, 0.3f, 0.7f, 0.5f});
  run = load(folder);
  CHECK(names(run) == "base_color, height, roughness");
  CHECK(run.get<Material>("material")->find("base_color")->read({0, 0, 1, 1}) == std::vector<float>{0.3f, 0.2f, 0.1f});
  CHECK(first_of(run, "height") == 0.7f);
  CHECK(run.says("ignored, the name says no map: wall.exr (layer Z)"));
  CHECK(first_of(load(folder, {{"mask", "wall.exr:Z"}}), "mask") == 57);
  fs::remove(folder.path() / "wall.exr");

  write_channels("wall_basecolor.exr", {"B", "G", "R", "Z"}, {0.1f, 0.2f, 0.3f, 57});
  run = load(folder);
  CHECK(names(run) == "base_color");
  CHECK(run.get<Material>("material")->find("base_color")->channels() == 3);
}

TEST_CASE("height in a colour's alpha and roughness in a normal's are maps where the names say so") {
  const TemporaryFolder folder;
  write(folder.path() / "rock_alb_ht.png", 4, ramp);
  write(folder.path() / "rock_nrm_rgh.png", 4, ramp);
  NodeRun run = load(folder);
  CHECK(names(run) == "base_color, normal, height, roughness");
  CHECK(first_of(run, "height") == ramp(0, 0, 3));
  CHECK(first_of(run, "roughness") == ramp(0, 0, 3));
  CHECK(run.get<Material>("material")->find("base_color")->channels() == 3);
  write(folder.path() / "rock_alb_ht.png", 4, [](int x, int y, int c) { return c == 3 ? 1.0f : ramp(x, y, c); });
  run = load(folder);
  CHECK(names(run) == "base_color, normal, roughness");
  CHECK(
      run.says("warning: rock_alb_ht.png: its alpha channel is full everywhere, so that it holds no height; left out"));
  CHECK(names(load(folder, {{"height", "rock_alb_ht.png:a"}})) == "base_color, normal, height, roughness");
  const Forecast seen = find_node_type("load_material")
                            ->preflight({{"path", folder.path().string()},
                                         {"name", std::string()},
                                         {"maps", TextMap{}},
                                         {"ignore", Texts{}},
                                         {"data", Texts{}},
                                         {"interpret", TextMap{}}},
                                        {});
  CHECK(std::ranges::count(*seen.possible_maps, "height") == 1);
  CHECK(std::ranges::count(seen.maps, "normal") == 1);
}

TEST_CASE("the alpha of a normal map is the height if the normals follow it, else it is left out with a warning") {
  const MaterialPtr wall = bricks(1);
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "wall_normal.png";
  write_normals(path, *wall->find("normal"), *wall->find("height"));
  NodeRun run = load(folder);
  CHECK(names(run) == "normal, height");
  CHECK(run.says("height: wall_normal.png (alpha channel): the normals follow its slopes"));
  write_normals(path, *wall->find("normal"), *wall->find("roughness"));
  run = load(folder);
  CHECK(names(run) == "normal");
  CHECK(
      run.says("warning: the alpha channel of wall_normal.png is left out. If it is a map, `maps` says which, as in "
               "{\"roughness\": \"wall_normal.png:a\"}"));
  write_normals(path, *wall->find("normal"), *wall->find("height"));
  write_image(*wall->find("height"), folder.path() / "wall_height.png", {}, [](double) {});
  CHECK(load(folder).says("the alpha channel of wall_normal.png is left out: there is a height map"));
}

TEST_CASE("roughness and metallic are read from green and blue, and what red holds is told") {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "Helmet_metalRoughness.png";
  write(path, 3, [](int x, int y, int c) { return c == 0 ? 0.0f : ramp(x, y, c); });
  NodeRun run = load(folder);
  CHECK(names(run) == "roughness, metallic");
  CHECK(first_of(run, "roughness") == ramp(0, 0, 1));
  CHECK(first_of(run, "metallic") == ramp(0, 0, 2));
  CHECK_FALSE(run.says("red is left out"));
  write(path, 3, ramp);
  CHECK(
      load(folder).says("Helmet_metalRoughness.png: roughness and metallic are read from green and blue, as in glTF; "
                        "red is left out. If it is occlusion, `maps` {\"ambient_occlusion\": "
                        "\"Helmet_metalRoughness.png:r\"} takes it in"));
  CHECK_FALSE(load(folder, {{"ambient_occlusion", "Helmet_metalRoughness.png:r"}}).says("red is left out"));
  write(path, 3, [](int x, int y, int c) { return c == 2 ? 0.0f : ramp(x, y, c); });
  run = load(folder);
  CHECK(run.says("warning: Helmet_metalRoughness.png"));
  CHECK(run.says("Blue is the same everywhere"));
}

TEST_CASE("a grey picture whose name may mean one map is that map alone") {
  const TemporaryFolder folder;
  write(folder.path() / "BrushedMetalRoughness.png", 3, [](int x, int y, int) { return ramp(x, y, 0); });
  NodeRun run = load(folder);
  CHECK(names(run) == "roughness");
  CHECK(run.says("BrushedMetalRoughness.png is a grey picture and not a packed one: it is read as roughness alone"));
  CHECK_FALSE(run.says("warning"));
}

TEST_CASE("channels that differ in a map of one value are a warning, and alpha that is left out is told") {
  const TemporaryFolder folder;
  write(folder.path() / "wall_roughness.png", 4, ramp);
  const NodeRun run = load(folder);
  CHECK(
      run.says("warning: wall_roughness.png: its channels differ, but roughness is one value at each pixel; red is "
               "used. If another channel holds it, or if the file holds several maps, `maps` says which: "
               "{\"roughness\": \"wall_roughness.png:g\"}"));
  CHECK(run.says("the alpha channel of wall_roughness.png is left out"));
  CHECK_FALSE(load(folder, {{"roughness", "wall_roughness.png:g"}}).says("warning"));
}

TEST_CASE("a map without a material's name is left out if its picture has nothing in common with the others") {
  const MaterialPtr wall = bricks(1);
  const TemporaryFolder folder;
  for (const char* map : {"base_color", "normal"})
    write_image(*wall->find(map), folder.path() / ("wall_" + std::string(map) + ".png"), {}, [](double) {});
  const fs::path path = folder.path() / "DisplacementMap.png";
  write_image(*wall->find("height"), path, {}, [](double) {});
  CHECK(names(load(folder)) == "base_color, normal, height");
  write_image(*run_node("noise", {{"size", Size{128, 128}}}).get<Image>("image"), path, {}, [](double) {});
  const NodeRun run = load(folder);
  CHECK(names(run) == "base_color, normal");
  CHECK(
      run.says("warning: DisplacementMap.png is left out: its name says no material, and its picture has nothing in "
               "common with the other maps"));
  CHECK(names(load(folder, {{"height", "DisplacementMap.png"}})) == "base_color, normal, height");
}
