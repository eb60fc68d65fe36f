#include <filesystem>

#include <doctest/doctest.h>

#include "core/image_io/image_file.h"
#include "tests/run_node.h"
#include "tests/texts.h"

/// What was written comes back as it was.
using namespace terrazzo;
using namespace terrazzo::test;
namespace fs = std::filesystem;

namespace {

float ramp(int x, int y, int c) {
  return float((x * 9 + y * 4 + c * 31) % 256) / 255.0f;
}

MaterialPtr wall(const std::string& name, PhysicalSize metres = {}) {
  const auto map = [](Semantic s, int channels, const std::string& space = "raw") {
    return make_image({8, 4}, channels, ramp, s, space);
  };
  return Material::make(name,
                        {{"base_color", map(Semantic::base_color, 3, "srgb_texture")},
                         {"normal", map(Semantic::normal, 3)},
                         {"roughness", map(Semantic::roughness, 1)}},
                        metres);
}

MaterialPtr read(const fs::path& folder, const std::string& name = "") {
  return run_node("load_material", {{"path", folder.string()}, {"name", name}}).get<Material>("material");
}

}  // namespace

TEST_CASE("exported normals say which way green points, and the maps how large they are, whatever their names say") {
  const TemporaryFolder folder;
  for (const char* extension : {"png", "tif", "exr"}) {
    CAPTURE(extension);
    const fs::path target = folder.path() / extension;
    run_node("export", {{"path", (target / "nor_gl_{map}.").string() + extension}, {"normal_y", "down"}},
             {{"material", {wall("wall", {2, 1})}}});
    const MaterialPtr back = read(target);
    CHECK(back->find("normal")->info().normal_y == NormalY::down);
    CHECK(back->metres() == PhysicalSize{2, 1});
    CHECK(back->map_names() == "base_color, normal, roughness");
  }
}

TEST_CASE("a packed file is read right by its own description when it is renamed and alone") {
  const TemporaryFolder folder;
  run_node("export_preset", {{"path", folder.path().string()}, {"preset", "unity_hdrp"}, {"depth", "uint8"}},
           {{"material", {wall("wall")}}});
  const fs::path alone = folder.path() / "alone";
  fs::create_directory(alone);
  fs::copy_file(folder.path() / "wall_MaskMap.png", alone / "final.png");
  const MaterialPtr back = read(alone);
  CHECK(back->find("roughness")->read({3, 2, 1, 1})[0] == doctest::Approx(ramp(3, 2, 0)));
}

TEST_CASE("UDIM tiles go to files that end in their tile, and come back as tiles") {
  const TemporaryFolder folder;
  for (const char* name : {"wall.1001", "wall.1012"})
    run_node("export", {{"path", (folder.path() / "{material}_{map}.<UDIM>.png").string()}},
             {{"material", {wall(name)}}});
  CHECK(listing(folder.path()) == std::vector<std::string>{"wall_base_color.1001.png", "wall_base_color.1012.png",
                                                           "wall_normal.1001.png", "wall_normal.1012.png",
                                                           "wall_roughness.1001.png", "wall_roughness.1012.png"});
  CHECK(read(folder.path(), "wall.1012")->name() == "wall.1012");
  CHECK(read(folder.path(), "wall.1012")->maps().size() == 3);
  CHECK(contains(
      error_of("export", {{"path", (folder.path() / "{map}.<UDIM>.png").string()}}, {{"material", {wall("wall")}}}),
      "is the tile that the material's name ends in, such as wall.1002; the material is called \"wall\""));
}

TEST_CASE("the tiles of a preset lie in one folder, each with its own sidecar") {
  const TemporaryFolder folder;
  for (const char* name : {"wall.1001", "wall.1002"})
    run_node("export_preset", {{"path", folder.path().string()}, {"preset", "unreal"}, {"format", "tga"}},
             {{"material", {wall(name, {name[8] == '1' ? 1.0 : 2.0, 1})}}});
  CHECK(fs::exists(folder.path() / "T_wall_ORM.1002.tga"));
  CHECK(fs::exists(folder.path() / "terrazzo-material.1001.json"));
  const MaterialPtr back = read(folder.path(), "wall.1002");
  CHECK(back->metres() == PhysicalSize{2, 1});
  CHECK(back->find("normal")->info().normal_y == NormalY::down);
  CHECK(read(folder.path(), "T_wall_ORM.1001")->metres() == PhysicalSize{1, 1});
}

TEST_CASE("mip levels are written as files beside the maps, and are not taken for maps") {
  const TemporaryFolder folder;
  run_node("export", {{"path", (folder.path() / "wall_{map}.png").string()}, {"mips", true}},
           {{"material", {wall("wall")}}});
  CHECK(listing(folder.path()).size() == 3 * 4);
  CHECK(read_image_info(folder.path() / "wall_normal.mip2.png").size == Size{2, 1});
  const NodeRun back = run_node("load_material", {{"path", folder.path().string()}});
  CHECK(back.get<Material>("material")->size() == Size{8, 4});
  CHECK(back.says("wall_normal.mip2.png left out: a level of a mip chain"));
}

TEST_CASE("TX files of a preset are read back") {
  const TemporaryFolder folder;
  run_node("export_preset", {{"path", folder.path().string()}, {"preset", "materialx"}, {"format", "tx"}},
           {{"material", {wall("wall", {1, 1})}}});
  CHECK(read(folder.path())->maps().size() == 3);
  CHECK(contains(read_text(folder.path() / "wall.mtlx"), "wall_base_color.tx"));
}
