#include "core/naming/file_stems.h"

#include <algorithm>

#include <doctest/doctest.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/material/material_files.h"

using namespace terrazzo;

namespace {

std::vector<MapFile> files(const std::vector<std::string>& names) {
  std::vector<MapFile> out;
  for (const std::string& n : names) out.push_back({.name = n, .size = {}});
  return out;
}

/// The names of the materials that the files make.
std::string materials(const std::vector<std::string>& names) {
  std::vector<std::string> out;
  for (const FolderMaterial& m : recognise_maps(files(names)).materials) out.push_back(m.name);
  return fmt::format("{}", fmt::join(out, ", "));
}

/// The files that are taken when a name is given.
std::string taken(const std::vector<std::string>& names, const std::string& name) {
  std::vector<std::string> out;
  for (const RecognisedMap& m : recognise_maps(files(names), {.name = name}).maps) out.push_back(m.file);
  return fmt::format("{}", fmt::join(out, ", "));
}

const std::vector<std::string> pack = {"Concrete07_1K-JPG_Color.jpg", "Concrete07_1K-JPG_NormalGL.jpg",
                                       "Leather05_2K_Color.png", "Leather05_2K_Roughness.png"};

}  // namespace

TEST_CASE("files of one material may spell its name in several ways") {
  const std::vector<std::vector<std::string>> folders = {
      {"bricks_basecolor.png", "bricks-2k_normal.png", "Bricks_Height_v02.tif", "BRICKS_4096x4096_roughness.exr"},
      {"OldBricks_Color.png", "oldbricks_Normal.png", "old_bricks_height.png"},
      {"wall_color.png", "wall_fine_normal.png", "wall_mixed_ao.png"},
      {"color.png", "normal.png", "Bricks075_2K-PNG_Displacement.png"},
      {"wall_color.png", "wall_normal.png", "wall_detail_normal.png"},
      {"wall_01_color_1k.png", "wall_01_normal_2k.png", "wall_height.png"},
      {"color_sand.png", "normal_sand.png", "height.png"},
      {"height_1.png", "height_2.png", "color.png"},
      {"wall_color.1001.exr", "wall_normal.1001.exr", "wall_roughness.exr"},
  };
  for (const auto& folder : folders) {
    INFO(fmt::format("{}", fmt::join(folder, ", ")));
    const Recognition r = recognise_maps(files(folder));
    CHECK(r.materials.size() == 1);
    CHECK_FALSE(r.maps.empty());
  }
}

TEST_CASE("several materials in a folder are told apart, and none is taken") {
  CHECK(materials(pack) == "Concrete07, Leather05");
  CHECK(recognise_maps(files(pack)).maps.empty());
  CHECK(materials({"Concrete07_Color.jpg", "Leather05_Roughness.jpg"}) == "Concrete07, Leather05");
  CHECK(materials({"wall_01_diff_1k.png", "wall_02_diff_1k.png"}) == "wall_01, wall_02");
  CHECK(materials({"sand_height.png", "sand_02_height.png"}) == "sand, sand_02");
  CHECK(materials({"rock_color.png", "rock_moss_color.png", "rock_normal.png"}) == "rock, rock_moss");
  CHECK(materials({"color_sand.png", "color_moss.png", "normal_sand.png"}) == "moss, sand");
  CHECK(materials({"a_color.png", "b_color.png", "height.png"}) == ", a, b");
  CHECK(recognise_maps(files(pack)).materials.front().maps == std::vector<std::string>{"base_color", "normal"});
}

TEST_CASE("UDIM tiles are materials of their own") {
  CHECK(materials({"wall_color.1001.exr", "wall_normal.1001.exr", "wall_color.1002.exr", "wall_normal.1002.exr"}) ==
        "wall.1001, wall.1002");
  CHECK(materials({"wall_1001_BaseColor.png", "wall_1011_BaseColor.png"}) == "wall.1001, wall.1011");
  CHECK(materials({"wall_color_u1_v1.tif", "wall_color_u2_v1.tif"}) == "wall.1001, wall.1002");
  CHECK(taken({"wall_color.1001.exr", "wall_color.1002.exr", "wall_normal.1002.exr"}, "wall.1002") ==
        "wall_color.1002.exr, wall_normal.1002.exr");
  CHECK(taken({"wall_color.1001.exr", "wall_color.1002.exr"}, "wall_color.1001") == "wall_color.1001.exr");
}

TEST_CASE("a name picks one material, a pattern takes several as one") {
  const std::string concrete = "Concrete07_1K-JPG_Color.jpg, Concrete07_1K-JPG_NormalGL.jpg";
  for (const char* name : {"Concrete07", "concrete07", "Concrete07_1K", "Concrete07_1K-JPG_Color", "conc*"}) {
    CAPTURE(name);
    CHECK(taken(pack, name) == concrete);
    CHECK(recognise_maps(files(pack), {.name = name}).name == "Concrete07");
  }
  CHECK(taken(pack, "*") == "Leather05_2K_Color.png, Concrete07_1K-JPG_NormalGL.jpg, Leather05_2K_Roughness.png");
  CHECK(recognise_maps(files(pack), {.name = "*"}).name.empty());
  CHECK(taken(pack, "Concrete08").empty());
  CHECK(taken({"rusty_metal_rough_diff_2k.jpg", "rusty_metal_rough_2k_nor.jpg", "sand_diff.jpg"},
              "rusty_metal_rough") == "rusty_metal_rough_diff_2k.jpg, rusty_metal_rough_2k_nor.jpg");
}

TEST_CASE("files whose names say nothing are kept as data where patterns say so") {
  const auto kept = [](const std::vector<std::string>& names, const RecognitionOptions& wishes) {
    const Recognition r = recognise_maps(files(names), wishes);
    std::vector<std::string> out;
    for (const RecognisedMap& m : r.maps)
      if (m.semantic == Semantic::data) out.push_back(m.map + "=" + m.file);
    for (const std::string& name : r.ignored) out.push_back("ignored " + name);
    return fmt::format("{}", fmt::join(out, ", "));
  };
  const std::vector<std::string> wall = {"wall_2K_color.png", "wall_2K_Translucency.png", "wall_2K_WarmGlow.png",
                                         "wall.png"};
  CHECK(kept(wall, {}) == "ignored wall.png, ignored wall_2K_Translucency.png, ignored wall_2K_WarmGlow.png");
  CHECK(kept(wall, {.data = {"*translucency*"}}) ==
        "data_translucency=wall_2K_Translucency.png, ignored wall.png, ignored wall_2K_WarmGlow.png");
  CHECK(kept(wall, {.data = {"*"}}) ==
        "data_translucency=wall_2K_Translucency.png, data_wall=wall.png, data_warm_glow=wall_2K_WarmGlow.png");
  CHECK(kept({"a.png", "b.png"}, {.data = {"*"}}) == "data_a=a.png, data_b=b.png");
  CHECK(kept({"a_color.png", "a_fuzz.png", "b_color.png", "b_fuzz.png"}, {.name = "b", .data = {"*"}}) ==
        "data_fuzz=b_fuzz.png, ignored a_fuzz.png");
  CHECK(kept({"wall_color.png", "wall_ID.png"}, {}) == "data_id=wall_ID.png");
  CHECK(kept({"wall_materialID.png"}, {}) == "data_id=wall_materialID.png");
}

TEST_CASE("a material's name may end in a UDIM tile") {
  CHECK(udim_tile_of("wall.1002") == "1002");
  CHECK(without_udim_tile("wall.1002") == "wall");
  CHECK(without_udim_tile("old_wall_1011") == "old_wall");
  for (const char* name : {"wall", "wall.2048", "1002 wall", "wall.1002b", ""}) {
    CHECK(udim_tile_of(name).empty());
    CHECK(without_udim_tile(name) == name);
  }
}
