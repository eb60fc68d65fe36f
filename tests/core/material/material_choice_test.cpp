#include "core/material/material_choice.h"

#include <algorithm>

#include <doctest/doctest.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/material/material_files.h"

using namespace terrazzo;

namespace {

using Names = std::vector<std::string>;

std::vector<MapFile> files(const Names& names, Size size = {}) {
  std::vector<MapFile> out;
  for (const std::string& n : names) out.push_back({.name = n, .size = size});
  return out;
}

std::string joined(const Names& names) {
  return fmt::format("{}", fmt::join(names, ", "));
}

std::string materials(const Names& names) {
  Names out;
  for (const FolderMaterial& m : recognise_maps(files(names)).materials) out.push_back(m.name);
  return joined(out);
}

std::string taken_of(const std::vector<MapFile>& files, const std::string& name = "") {
  Names out;
  for (const RecognisedMap& m : recognise_maps(files, {.name = name}).maps) out.push_back(m.file);
  return joined(out);
}

std::string taken(const Names& names, const std::string& name = "") {
  return taken_of(files(names), name);
}

bool has_note(const Recognition& r, const std::string& part) {
  return std::ranges::any_of(r.notes, [&](const std::string& n) { return n.find(part) != std::string::npos; });
}

}  // namespace

TEST_CASE("a material whose name another's ends with is told apart from it, by its exact name") {
  const Names stones = {"Stone_basecolor.png",    "Stone_normal.png",         "Stone_roughness.png",
                        "Wall_Stone_normal.png",  "Wall_Stone_roughness.png", "wall_stone.png",
                        "oldWallStoneNormal.tif", "oldWallStoneHeight.tif"};
  CHECK(materials(stones) == "Stone, Wall_Stone, oldWallStone");
  CHECK(taken(stones).empty());
  CHECK(taken(stones, "Stone") == "Stone_basecolor.png, Stone_normal.png, Stone_roughness.png");
  for (const char* name : {"Wall_Stone", "wall stone", "WallStone"})
    CHECK(taken(stones, name) == "wall_stone.png, Wall_Stone_normal.png, Wall_Stone_roughness.png");
  CHECK(taken(stones, "old-wall-stone") == "oldWallStoneNormal.tif, oldWallStoneHeight.tif");
  // Nothing clashes: without a name they are one.
  const Names apart = {"stone_color.png", "wall_stone_height.png"};
  CHECK(taken(apart) == "stone_color.png, wall_stone_height.png");
  CHECK(taken(apart, "wall_stone") == "wall_stone_height.png");
  CHECK(recognise_maps(files(apart), {.name = "wall_stone"}).name == "wall_stone");
  CHECK(has_note(recognise_maps(files(apart), {.name = "wall_stone"}),
                 R"(left out, not of "wall_stone": stone_color.png)"));
  // Further words behind the name belong to it, unless they hold the same map.
  CHECK(taken({"wall_color.png", "wall_fine_normal.png"}, "wall_fine") == "wall_color.png, wall_fine_normal.png");
  const Names fine = {"wall_color.png", "wall_normal.png", "wall_fine_normal.png", "wall_fine_height.png"};
  CHECK(taken(fine, "wall") == "wall_color.png, wall_normal.png");
  CHECK(taken(fine, "wall_fine") == "wall_fine_normal.png, wall_fine_height.png");
}

TEST_CASE("words such as texture in front count only where names clash without them") {
  const Names rocks = {"rock_albedo.png", "rock_normal.png", "texture_rock_albedo.png", "texture_rock_normal.png",
                       "texture_rock_ao.png"};
  CHECK(materials(rocks) == "rock, texture_rock");
  CHECK(taken(rocks, "rock") == "rock_albedo.png, rock_normal.png");
  CHECK(taken(rocks, "Texture-Rock") == "texture_rock_albedo.png, texture_rock_normal.png, texture_rock_ao.png");
  CHECK(materials({"MapRockColor.png", "RockColor.png", "TexRockColor.png"}) == "MapRock, Rock, TexRock");
  CHECK(taken({"MapRockColor.png", "RockColor.png", "TexRockColor.png"}, "tex rock") == "TexRockColor.png");
  CHECK(materials({"tex_rock_albedo.png", "rock_normal.png", "map_rock_ao.png"}) == "rock");
  CHECK(taken({"texture_rock_albedo.png", "texture_rock_ao.png"}, "rock") ==
        "texture_rock_albedo.png, texture_rock_ao.png");
  CHECK(taken({"texture_rock_albedo.png", "texture_rock_ao.png"}, "texture_rock") ==
        "texture_rock_albedo.png, texture_rock_ao.png");
  const Recognition kept = recognise_maps(files({"rock_albedo.png", "rock_fuzz.png", "texture_rock_albedo.png"}),
                                          {.name = "rock", .data = {"*fuzz*"}});
  CHECK(kept.maps.back().map == "data_fuzz");
}

TEST_CASE("a keyword beats the same keyword with further words") {
  for (const auto& [plain, further] : std::vector<std::pair<std::string, std::string>>{
           {"wall_basecolor.png", "wall_basecolor-boosted.png"},
           {"wall_basecolor.jpg", "wall_basecolor_boosted.exr"},
           {"WallBaseColor_2K.png", "WallBaseColorVivid_4K.png"},
           {"basecolor.png", "basecolor-boosted.png"},
           {"albedo.png", "albedo old.png"},
           {"normal_gl.png", "normal_gl_soft.png"},
       }) {
    CAPTURE(further);
    const Recognition r = recognise_maps(files({further, plain}));
    CHECK(taken({further, plain}) == plain);
    CHECK(has_note(r, further + " left out"));
  }
  CHECK(materials({"color.png", "color_sand.png", "normal_sand.png"}) == ", sand");
  CHECK(taken({"wall_basecolor-boosted.png", "wall_normal.png"}) == "wall_basecolor-boosted.png, wall_normal.png");
}

TEST_CASE("a picture named just like the material is its base colour, unless it has one, or is smaller") {
  CHECK(taken({"wall_stone.png", "Wall_Stone_normal.png"}) == "wall_stone.png, Wall_Stone_normal.png");
  CHECK(taken({"Wall-Stone_2K.JPG", "wall stone rough.tif"}) == "Wall-Stone_2K.JPG, wall stone rough.tif");
  CHECK(taken({"wall.1001.png", "wall_normal.1001.png"}) == "wall.1001.png, wall_normal.1001.png");
  CHECK(taken({"Bricks001.png", "Bricks001_Color.png"}) == "Bricks001_Color.png");
  CHECK(taken({"other.png", "wall_normal.png"}) == "wall_normal.png");
  CHECK(taken({"wall_preview.png", "wall_normal.png"}) == "wall_normal.png");
  const Recognition r = recognise_maps(files({"wall.png", "wall_normal.png"}));
  CHECK(has_note(r, "base_color is wall.png: it is named like the material"));
  CHECK(r.ignored.empty());
  std::vector<MapFile> sized = files({"wall.png", "wall_normal.png"}, {64, 64});
  CHECK(taken_of(sized) == "wall.png, wall_normal.png");
  sized[0].size = {32, 32};
  CHECK(taken_of(sized) == "wall_normal.png");
  CHECK(recognise_maps(sized).ignored == Names{"wall.png"});
  sized[0].size = {128, 128};
  CHECK(taken_of(sized) == "wall.png, wall_normal.png");
  sized[0].size = {128, 64};
  CHECK(taken_of(sized) == "wall_normal.png");
  sized[0].size = {64, 64};
  sized[0].channels = 1;
  CHECK(taken_of(sized) == "wall_normal.png");
}

TEST_CASE("letters in a material's name are of no map if another file has the whole name before its own") {
  const auto color_of = [](const Names& names) {
    std::string out;
    for (const RecognisedMap& m : recognise_maps(files(names, {64, 64})).maps)
      if (m.semantic == Semantic::base_color) out = m.file;
    return out;
  };
  CHECK(color_of({"tiles_m_6.jpg", "tiles_m_6_nm.png"}) == "tiles_m_6.jpg");
  CHECK(color_of({"bricks_c_1.jpg", "bricks_c_1_normal.png"}) == "bricks_c_1.jpg");
  CHECK(color_of({"wall_r.png", "wall_r_normal.png"}) == "wall_r.png");
  // What says it in words, or has no such other file, stays what it is.
  CHECK(color_of({"wall_height.png", "wall_height_normal.png"}).empty());
  CHECK(color_of({"wall_m.png", "wall_n.png"}).empty());
  CHECK(color_of({"tiles_m_6.jpg", "tiles_m_6_nm.png", "tiles_m_6_color.png"}) == "tiles_m_6_color.png");
  // A grey picture is no colour.
  std::vector<MapFile> grey = files({"tiles_m_6.jpg", "tiles_m_6_nm.png"}, {64, 64});
  grey[0].channels = 1;
  CHECK(taken_of(grey) == "tiles_m_6_nm.png, tiles_m_6.jpg");  // a metallic map
}

TEST_CASE("a map without a material's name joins only what has its size") {
  std::vector<MapFile> all = files({"wall_color.png", "wall_normal.png", "DisplacementMap.png"}, {64, 64});
  CHECK(taken_of(all) == "wall_color.png, wall_normal.png, DisplacementMap.png");
  all[1].size = {32, 32};
  CHECK(taken_of(all) == "wall_color.png, wall_normal.png, DisplacementMap.png");
  all[2].size = {48, 48};
  CHECK(taken_of(all) == "wall_color.png, wall_normal.png");
  CHECK(
      has_note(recognise_maps(all),
               R"(warning: DisplacementMap.png (48x48) is left out: its name says no material, and no map of a named )"
               R"(one has its size. `maps` {"height": "DisplacementMap.png"} takes it in)"));
  // The nameless ones are the material here.
  std::vector<MapFile> plain = files({"color.png", "normal.png", "Bricks075_Displacement.png"}, {64, 64});
  plain[2].size = {32, 32};
  CHECK(taken_of(plain) == "color.png, normal.png, Bricks075_Displacement.png");
}
