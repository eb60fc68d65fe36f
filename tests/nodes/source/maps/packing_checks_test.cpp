#include "nodes/source/maps/packing_checks.h"

#include <algorithm>
#include <filesystem>

#include <doctest/doctest.h>

#include "core/image_io/image_file.h"
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

TEST_CASE("channels of a packed file that no map takes are a warning if they hold something of their own") {
  const TemporaryFolder folder;
  const fs::path orm = folder.path() / "wall_ORM.png";
  write(orm, 4, ramp);
  CHECK(load(folder).says(
      "warning: wall_ORM.png: its channel a is left out, and not the same everywhere. If it is a map, "
      "`maps` says which, as in {\"ambient_occlusion\": \"wall_ORM.png:a\"}"));
  CHECK_FALSE(load(folder, {{"height", "wall_ORM.png:a"}}).says("warning"));
  CHECK_FALSE(load(folder, {{"ambient_occlusion", ""}, {"height", "wall_ORM.png:a"}}).says("warning"));
  write(orm, 4, [](int x, int y, int c) { return c == 3 ? 0.5f : ramp(x, y, c); });
  CHECK_FALSE(load(folder).says("warning"));
  fs::remove(orm);

  const fs::path gltf = folder.path() / "wall_metalRoughness.png";
  write(gltf, 4, [](int x, int y, int c) { return c == 0 ? 0.0f : ramp(x, y, c); });
  CHECK(load(folder).says("warning: wall_metalRoughness.png: its channel a is left out"));
  fs::remove(gltf);

  const fs::path unity = folder.path() / "wall_MetallicGlossMap.png";
  write(unity, 4, ramp);
  CHECK(
      load(folder).says("warning: wall_MetallicGlossMap.png: its channels g and b are left out, and not the same "
                        "everywhere. If one is a map, `maps` says which, as in {\"ambient_occlusion\": "
                        "\"wall_MetallicGlossMap.png:g\"}"));
  write(unity, 4, [](int x, int y, int c) { return ramp(x, y, c == 3 ? 3 : 0); });
  CHECK_FALSE(load(folder).says("left out"));
}

TEST_CASE("an opacity map that is only in alpha is read from there, other maps are warned of") {
  const TemporaryFolder folder;
  const auto white_with_alpha = [](int x, int y, int c) { return c == 3 ? ramp(x, y, 0) : 1.0f; };
  write(folder.path() / "leaf_opacity.png", 4, white_with_alpha);
  NodeRun run = load(folder);
  CHECK(run.get<Material>("material")->find("opacity")->read({5, 7, 1, 1})[0] == ramp(5, 7, 0));
  CHECK(
      run.says("opacity: leaf_opacity.png is the same everywhere but for its alpha channel, which is read; `maps` "
               "{\"opacity\": \"leaf_opacity.png:r\"} says otherwise"));
  CHECK_FALSE(run.says("left out"));
  CHECK(first_of(load(folder, {{"opacity", "leaf_opacity.png:r"}}), "opacity") == 1);
  CHECK(run_node("load_map", {{"path", (folder.path() / "leaf_opacity.png").string()}, {"semantic", "opacity"}})
            .says("warning: only the map's first channel counts, not its alpha"));
  fs::remove(folder.path() / "leaf_opacity.png");

  write(folder.path() / "leaf_height.png", 4, white_with_alpha);
  run = load(folder);
  CHECK(first_of(run, "height") == 1);
  CHECK(
      run.says("warning: the alpha channel of leaf_height.png is left out, though all else in it is the same "
               "everywhere. If it is a map, `maps` says which, as in {\"height\": \"leaf_height.png:a\"}"));
}

TEST_CASE("alpha without a layer beside a named layer of an EXR file is the alpha of that map, and no map itself") {
  const TemporaryFolder folder;
  const auto pixel = [&](const char* file, const std::vector<std::string>& channels, const std::vector<float>& values) {
    write_odd(folder.path() / file,
              {.size = {1, 1}, .channels = int(channels.size()), .type = "float", .channel_names = channels}, values);
  };
  pixel("wall_albedo.exr", {"A", "albedo.B", "albedo.G", "albedo.R"}, {0.5f, 0.1f, 0.2f, 0.3f});
  pixel("wall_height.exr", {"A", "Displacement.Y"}, {1, 0.7f});
  pixel("wall_normal.exr", {"A", "normal.X", "normal.Y", "normal.Z"}, {1, -0.6f, 0, 0.8f});
  const NodeRun run = load(folder);
  CHECK(names(run) == "base_color, normal, height, opacity");
  CHECK(run.get<Material>("material")->find("base_color")->read({0, 0, 1, 1}) == std::vector<float>{0.3f, 0.2f, 0.1f});
  CHECK(first_of(run, "opacity") == 0.5f);
  CHECK(first_of(run, "height") == 0.7f);
}
