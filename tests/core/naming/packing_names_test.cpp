#include "core/naming/packing_names.h"

#include <doctest/doctest.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/material/material_files.h"

using namespace terrazzo;

namespace {

/// "roughness=g metallic=b": the maps in a file of that many channels, "~" before those that are inverted.
std::string maps_in(const std::string& name, int channels) {
  std::vector<std::string> out;
  for (const RecognisedMap& m : recognise_maps({{.name = name, .size = {}, .channels = channels}}).maps)
    out.push_back(fmt::format("{}{}={}", m.inverted ? "~" : "", m.map, m.channels));
  return fmt::format("{}", fmt::join(out, " "));
}

}  // namespace

TEST_CASE("names that list maps say which channel holds which") {
  const std::string orm = "roughness=g metallic=b ambient_occlusion=r";
  for (const char* name :
       {"Helmet_OcclusionRoughMetal.png", "Boom_occlusionRoughnessMetallic.png", "x_AO_Rough_Metal.png",
        "wall_Occlusion_Roughness_Metalness.jpg", "wall_occlusionroughmetal.tga", "wall-aorm.png", "wallAORM.png",
        "wall_AO-R-M.tif", "wall_AmbientOcclusionRoughnessMetallic_2k.png", "T_Wall_ORM.png"}) {
    CAPTURE(name);
    CHECK(maps_in(name, 3) == orm);
  }
  for (const char* name :
       {"Default_metalRoughness.jpg", "Suzanne_MetallicRoughness.png", "Lantern_roughnessMetallic.png",
        "Spheres_MetalRough.png", "wall_metalroughness.webp", "metalRoughness.png"}) {
    CAPTURE(name);
    CHECK(maps_in(name, 3) == "roughness=g metallic=b");
  }
  CHECK(maps_in("wall_RoughnessMetallicAO.png", 3) == "roughness=r metallic=g ambient_occlusion=b");
  CHECK(maps_in("wall_HeightRoughnessAO.png", 4) == "height=r roughness=g ambient_occlusion=b");
  CHECK(maps_in("wall_AORoughnessMetallicHeight.png", 4) == "height=a roughness=g metallic=b ambient_occlusion=r");
  CHECK(maps_in("wall_ORDp.png", 3) == "height=b roughness=g ambient_occlusion=r");
  CHECK(maps_in("wall_rmao.png", 3) == "roughness=r metallic=g ambient_occlusion=b");
  CHECK(maps_in("Wall_MetallicGloss.png", 4) == "~roughness=a metallic=r");
}

TEST_CASE("short words for maps may be an asset's name") {
  CHECK(maps_in("rusty_metal_rough_ao_2k.jpg", 3) == "ambient_occlusion=");
  CHECK(maps_in("rusty_metal_roughness_2k.jpg", 3) == "roughness=");
  CHECK(maps_in("rusty_metal_rough_rough_2k.jpg", 3) == "roughness=");
  CHECK(maps_in("metal_rough_height.png", 3) == "height=");
  CHECK(maps_in("occlusion.png", 3) == "ambient_occlusion=");
}

TEST_CASE("a name of two maps means colour or normal with the other in alpha where there is one") {
  CHECK(maps_in("rock_alb_ht.png", 4) == "base_color=rgb height=a");
  CHECK(maps_in("rock_nrm_rgh.png", 4) == "normal=rgb roughness=a");
  CHECK(maps_in("Rock-Albedo-Height.tif", 4) == "base_color=rgb height=a");
  CHECK(maps_in("RockNormalHeight.tga", 4) == "normal=rgb height=a");
  CHECK(maps_in("T_Rock_N_H.png", 4) == "normal=rgb height=a");
  CHECK(maps_in("Rock NormalGloss.png", 4) == "normal=rgb ~roughness=a");
  CHECK(maps_in("rock_diffuse_alpha.png", 4) == "base_color=rgb opacity=a");
  CHECK(maps_in("rock_color_mask.png", 4) == "mask=");
  CHECK(maps_in("red_normal_bricks_height.png", 4) == "height=");
  CHECK(maps_in("rock_alb_ht.png", 1) == "height=");
  const std::vector<RecognisedMap> maps =
      recognise_maps({{.name = "rock_nrm_dx_rgh.png", .size = {}, .channels = 4}}).maps;
  REQUIRE(maps.size() == 2);
  CHECK(maps.front().normal_y == NormalY::down);
}

TEST_CASE("lists of other words, or of one map twice, are no packing") {
  for (const char* text : {"", "roughness", "roughnessroughness", "metallicheight", "roughlymetal", "aoheight",
                           "aoroughnessmetallicheightopacity", "smoothnessmetallic"}) {
    CAPTURE(text);
    CHECK(packing_in(text).parts.empty());
  }
  CHECK(packing_in("metallicsmoothness").least_channels == 4);
  CHECK(packing_in("aoroughmetal").begins_with_full);
  CHECK_FALSE(packing_in("metalrough").has_full_word);
}
