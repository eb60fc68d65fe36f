#include "core/material/material_files.h"

#include <algorithm>

#include <doctest/doctest.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

using namespace terrazzo;

namespace {

/// "map=file" per map, "[channels]" after the file where only some are meant, "~" before it if inverted, and the
/// convention of normals where the name says it.
std::string shown(const RecognisedMap& m) {
  return fmt::format("{}={}{}{}{}", m.map, m.inverted ? "~" : "", m.file,
                     m.channels.empty() ? "" : "[" + m.channels + "]",
                     !m.normal_y                  ? ""
                     : *m.normal_y == NormalY::up ? " up"
                                                  : " down");
}

std::vector<std::string> shown(const std::vector<RecognisedMap>& maps) {
  std::vector<std::string> out;
  for (const RecognisedMap& m : maps) out.push_back(shown(m));
  return out;
}

std::vector<MapFile> files(const std::vector<std::string>& names) {
  std::vector<MapFile> out;
  for (const std::string& n : names) out.push_back({.name = n, .size = {}});
  return out;
}

bool has_note(const Recognition& r, const std::string& part) {
  return std::any_of(r.notes.begin(), r.notes.end(),
                     [&](const std::string& n) { return n.find(part) != std::string::npos; });
}

struct Convention {
  const char* who;
  std::vector<std::string> names;
  std::vector<std::string> expected;
  std::vector<std::string> ignored = {};
};

}  // namespace

TEST_CASE("the naming conventions of the usual sources are recognised") {
  const std::vector<Convention> conventions = {
      {"ambientCG",
       {"Bricks001_1K-JPG_AmbientOcclusion.jpg", "Bricks001_1K-JPG_Color.jpg", "Bricks001_1K-JPG_Displacement.jpg",
        "Bricks001_1K-JPG_NormalDX.jpg", "Bricks001_1K-JPG_NormalGL.jpg", "Bricks001_1K-JPG_Roughness.jpg",
        "Bricks001_1K-JPG_Metalness.jpg", "Bricks001_1K-JPG_Opacity.jpg", "Bricks001_1K-JPG_Emission.jpg",
        "Bricks001_PREVIEW.jpg", "Bricks001.png"},
       {"base_color=Bricks001_1K-JPG_Color.jpg", "normal=Bricks001_1K-JPG_NormalGL.jpg up",
        "height=Bricks001_1K-JPG_Displacement.jpg", "roughness=Bricks001_1K-JPG_Roughness.jpg",
        "metallic=Bricks001_1K-JPG_Metalness.jpg", "ambient_occlusion=Bricks001_1K-JPG_AmbientOcclusion.jpg",
        "opacity=Bricks001_1K-JPG_Opacity.jpg", "emission=Bricks001_1K-JPG_Emission.jpg"},
       {"Bricks001.png"}},
      {"ambientCG, older",
       {"Metal009_2K_Color.jpg", "Metal009_2K_Normal.jpg", "Metal009_2K_Metalness.jpg", "Metal009.png"},
       {"base_color=Metal009_2K_Color.jpg", "normal=Metal009_2K_Normal.jpg", "metallic=Metal009_2K_Metalness.jpg"},
       {"Metal009.png"}},
      {"Poly Haven",
       {"rusty_metal_rough_diff_2k.jpg", "rusty_metal_rough_nor_gl_2k.exr", "rusty_metal_rough_nor_dx_2k.exr",
        "rusty_metal_rough_rough_2k.jpg", "rusty_metal_rough_disp_2k.png", "rusty_metal_rough_ao_2k.jpg",
        "rusty_metal_rough_arm_2k.jpg", "rusty_metal_rough_spec_2k.jpg", "rusty_metal_rough_bump_2k.jpg"},
       {"base_color=rusty_metal_rough_diff_2k.jpg", "normal=rusty_metal_rough_nor_gl_2k.exr up",
        "height=rusty_metal_rough_disp_2k.png", "roughness=rusty_metal_rough_rough_2k.jpg",
        "metallic=rusty_metal_rough_arm_2k.jpg[b]", "ambient_occlusion=rusty_metal_rough_ao_2k.jpg",
        "specular=rusty_metal_rough_spec_2k.jpg"}},
      {"Poly Haven, packed only",
       {"sand_01_diff_1k.png", "sand_01_arm_1k.png"},
       {"base_color=sand_01_diff_1k.png", "roughness=sand_01_arm_1k.png[g]", "metallic=sand_01_arm_1k.png[b]",
        "ambient_occlusion=sand_01_arm_1k.png[r]"}},
      {"Substance",
       {"Wall_BaseColor.png", "Wall_Normal_OpenGL.png", "Wall_Roughness.png", "Wall_Metallic.png", "Wall_Height.png",
        "Wall_AmbientOcclusion.png", "Wall_Opacity.png", "Wall_Emissive.png"},
       {"base_color=Wall_BaseColor.png", "normal=Wall_Normal_OpenGL.png up", "height=Wall_Height.png",
        "roughness=Wall_Roughness.png", "metallic=Wall_Metallic.png", "ambient_occlusion=Wall_AmbientOcclusion.png",
        "opacity=Wall_Opacity.png", "emission=Wall_Emissive.png"}},
      {"Substance, lower camel case",
       {"wall_baseColor.png", "wall_normal_directx.png", "wall_roughness.png", "wall_metallic.png", "wall_AO.png"},
       {"base_color=wall_baseColor.png", "normal=wall_normal_directx.png down", "roughness=wall_roughness.png",
        "metallic=wall_metallic.png", "ambient_occlusion=wall_AO.png"}},
      {"Quixel Megascans",
       {"tgvmcdj_2K_Albedo.jpg", "tgvmcdj_2K_Normal.jpg", "tgvmcdj_2K_Normal_LOD1.jpg", "tgvmcdj_2K_Roughness.jpg",
        "tgvmcdj_2K_Gloss.jpg", "tgvmcdj_2K_Displacement.exr", "tgvmcdj_2K_AO.jpg", "tgvmcdj_2K_Cavity.jpg",
        "tgvmcdj_2K_Specular.jpg", "tgvmcdj_2K_Opacity.jpg", "tgvmcdj_2K_Bump.jpg", "tgvmcdj_Preview.png",
        "tgvmcdj_Billboard_1.png"},
       {"base_color=tgvmcdj_2K_Albedo.jpg", "normal=tgvmcdj_2K_Normal.jpg", "height=tgvmcdj_2K_Displacement.exr",
        "roughness=tgvmcdj_2K_Roughness.jpg", "ambient_occlusion=tgvmcdj_2K_AO.jpg", "opacity=tgvmcdj_2K_Opacity.jpg",
        "specular=tgvmcdj_2K_Specular.jpg", "data_cavity=tgvmcdj_2K_Cavity.jpg"}},
      {"Unreal",
       {"T_Cobble_D.tga", "T_Cobble_N.tga", "T_Cobble_R.tga", "T_Cobble_M.tga", "T_Cobble_AO.tga", "T_Cobble_H.tga",
        "T_Cobble_E.tga"},
       {"base_color=T_Cobble_D.tga", "normal=T_Cobble_N.tga", "height=T_Cobble_H.tga", "roughness=T_Cobble_R.tga",
        "metallic=T_Cobble_M.tga", "ambient_occlusion=T_Cobble_AO.tga", "emission=T_Cobble_E.tga"}},
      {"Unreal, packed",
       {"T_Cobble_BC_4K.png", "T_Cobble_N_4K.png", "T_Cobble_ORM_4K.png"},
       {"base_color=T_Cobble_BC_4K.png", "normal=T_Cobble_N_4K.png", "roughness=T_Cobble_ORM_4K.png[g]",
        "metallic=T_Cobble_ORM_4K.png[b]", "ambient_occlusion=T_Cobble_ORM_4K.png[r]"}},
      {"Unity",
       {"Wall_AlbedoTransparency.png", "Wall_MetallicSmoothness.png", "Wall_Normal.png", "Wall_Occlusion.png",
        "Wall_Height.png"},
       {"base_color=Wall_AlbedoTransparency.png[rgb]", "normal=Wall_Normal.png", "height=Wall_Height.png",
        "roughness=~Wall_MetallicSmoothness.png[a]", "metallic=Wall_MetallicSmoothness.png[r]",
        "ambient_occlusion=Wall_Occlusion.png", "opacity=Wall_AlbedoTransparency.png[a]"}},
      {"Unity HDRP",
       {"Wall_BaseMap.png", "Wall_MaskMap.png", "Wall_NormalMap.png"},
       {"base_color=Wall_BaseMap.png", "normal=Wall_NormalMap.png", "roughness=~Wall_MaskMap.png[a]",
        "metallic=Wall_MaskMap.png[r]", "ambient_occlusion=Wall_MaskMap.png[g]", "mask_detail=Wall_MaskMap.png[b]"}},
      {"glTF",
       {"wood_baseColor.jpeg", "wood_metallicRoughness.png", "wood_normal.png", "wood_occlusion.png",
        "wood_emissive.png"},
       {"base_color=wood_baseColor.jpeg", "normal=wood_normal.png", "roughness=wood_metallicRoughness.png[g]",
        "metallic=wood_metallicRoughness.png[b]", "ambient_occlusion=wood_occlusion.png",
        "emission=wood_emissive.png"}},
      {"plain names",
       {"basecolor.png", "normal.png", "height.png", "roughness.png", "metallic.png", "ao.png", "opacity.png",
        "emission.png", "specular.png"},
       {"base_color=basecolor.png", "normal=normal.png", "height=height.png", "roughness=roughness.png",
        "metallic=metallic.png", "ambient_occlusion=ao.png", "opacity=opacity.png", "emission=emission.png",
        "specular=specular.png"}},
      {"short plain names",
       {"col.png", "nrm.png", "disp.png", "rgh.png", "alpha.png"},
       {"base_color=col.png", "normal=nrm.png", "height=disp.png", "roughness=rgh.png", "opacity=alpha.png"}},
      {"games: the plain name is the colour",
       {"floor015.png", "floor015_nm.png", "floor015_gloss.tga"},
       {"base_color=floor015.png", "normal=floor015_nm.png", "roughness=~floor015_gloss.tga"}},
      {"bricks1",
       {"bricks1.tga", "bricks1_nm.tga", "bricks1_hm.tga", "bricks1_glossy.jpg"},
       {"base_color=bricks1.tga", "normal=bricks1_nm.tga", "height=bricks1_hm.tga", "roughness=~bricks1_glossy.jpg"}},
      {"our own exports",
       {"base_color.png", "normal.png", "height.png", "ambient_occlusion.png", "uv.png"},
       {"base_color=base_color.png", "normal=normal.png", "height=height.png",
        "ambient_occlusion=ambient_occlusion.png"},
       {"uv.png"}},
  };
  for (const Convention& c : conventions) {
    INFO(c.who);
    const Recognition r = recognise_maps(files(c.names));
    CHECK(shown(r.maps) == c.expected);
    CHECK(fmt::format("{}", fmt::join(r.ignored, ", ")) == fmt::format("{}", fmt::join(c.ignored, ", ")));
  }
}

TEST_CASE("Unity's words for properties count, and the convention of normals where no other word says a map") {
  const auto maps = [](const std::vector<std::string>& names) { return shown(recognise_maps(files(names)).maps); };
  CHECK(maps({"Wall_MainTex.png", "Wall_ParallaxMap.png"}) ==
        std::vector<std::string>{"base_color=Wall_MainTex.png", "height=Wall_ParallaxMap.png"});
  CHECK(maps({"slate2-tiled-albedo2.png", "slate2-tiled-ogl.png", "slate2-tiled-rough2.png"}) ==
        std::vector<std::string>{"base_color=slate2-tiled-albedo2.png", "normal=slate2-tiled-ogl.png up",
                                 "roughness=slate2-tiled-rough2.png"});
  CHECK(maps({"slate_2k_dx.png"}) == std::vector<std::string>{"normal=slate_2k_dx.png down"});
  CHECK(maps({"slate_rough_dx.png"}) == std::vector<std::string>{"roughness=slate_rough_dx.png"});
  CHECK(maps({"ogl.png", "wall_gl.png", "dx_wall.png"}).empty());
  CHECK(recognise_map({.name = "slate_ogl.png", .size = {}, .channels = 1}).empty());
}

TEST_CASE("files as sites and programs ship them are recognised by name") {
  struct Shipped {
    const char* name;
    const char* map;  ///< as `shown` says it, without the file; empty if it is none
  };
  const std::vector<Shipped> shipped = {
      // ambientCG
      {"Bricks075A_2K-PNG_Color.png", "base_color"},
      {"Bricks075A_2K-PNG_NormalGL.png", "normal up"},
      {"Bricks075A_2K-PNG_NormalDX.png", "normal down"},
      {"Bricks075A_2K-PNG_Displacement.png", "height"},
      {"Bricks075A_2K-PNG_AmbientOcclusion.png", "ambient_occlusion"},
      {"Bricks075A_2K-PNG.usdc", ""},
      // Poly Haven
      {"brick_wall_001_diff_2k.jpg", "base_color"},
      {"brick_wall_001_diffuse_2k.jpg", "base_color"},
      {"brick_wall_001_nor_gl_2k.exr", "normal up"},
      {"brick_wall_001_nor_dx_2k.exr", "normal down"},
      {"brick_wall_001_arm_2k.jpg", "roughness[g] metallic[b] ambient_occlusion[r]"},
      {"brick_wall_001_disp_2k.png", "height"},
      {"brick_wall_001_rough_2k.jpg", "roughness"},
      {"brick_wall_001_ao_2k.jpg", "ambient_occlusion"},
      // Quixel Megascans
      {"tgspecch_2K_Albedo.jpg", "base_color"},
      {"tgspecch_2K_AO.jpg", "ambient_occlusion"},
      {"tgspecch_2K_Bump.jpg", "height"},
      {"tgspecch_2K_Cavity.jpg", "data_cavity"},
      {"tgspecch_2K_Displacement.exr", "height"},
      {"tgspecch_2K_Gloss.jpg", "~roughness"},
      {"tgspecch_2K_Normal_LOD0.jpg", "normal"},
      {"tgspecch_2K_Specular.jpg", "specular"},
      {"tgspecch_2K_Fuzz.jpg", ""},
      {"tgspecch_2K_Translucency.jpg", ""},
      // Substance
      {"wall_BaseColor.png", "base_color"},
      {"wall_Base_Color.png", "base_color"},
      {"wall_OcclusionRoughnessMetallic.png", "roughness[g] metallic[b] ambient_occlusion[r]"},
      {"wall_Mixed_AO.png", "ambient_occlusion"},
      {"wall_Normal_OpenGL.png", "normal up"},
      {"wall_world_space_normals.png", ""},
      // Textures.com
      {"TexturesCom_Brick_Wall_512_albedo.tif", "base_color"},
      {"TexturesCom_Brick_Wall_512_ao.tif", "ambient_occlusion"},
      {"TexturesCom_Brick_Wall_512_height.tif", "height"},
      {"TexturesCom_Brick_Wall_512_normal.tif", "normal"},
      {"TexturesCom_Brick_Wall_512_roughness.tif", "roughness"},
      // Poliigon
      {"MetalBare_COL_2K_METALNESS.png", "base_color"},
      {"MetalBare_METALNESS_2K_METALNESS.png", "metallic"},
      {"MetalBare_NRM_2K_METALNESS.png", "normal"},
      {"MetalBare_ROUGHNESS_2K_METALNESS.png", "roughness"},
      {"MetalBare_DISP16_2K_METALNESS.tif", "height"},
      {"MetalBare_COL_2K_SPECULAR.jpg", "base_color"},
      {"MetalBare_REFL_2K_SPECULAR.jpg", "specular"},
      {"BricksWhite01_COL_VAR1_2K.jpg", "base_color"},
      {"BricksWhite01_NRM_2K.jpg", "normal"},
      {"BricksWhite01_NRM16_2K.tif", "normal"},
      {"BricksWhite01_GLOSS_2K.jpg", "~roughness"},
      {"BricksWhite01_REFL_2K.jpg", "specular"},
      {"BricksWhite01_DISP_2K.jpg", "height"},
      {"BricksWhite01_DISP16_2K.tif", "height"},
      {"BricksWhite01_AO_2K.jpg", "ambient_occlusion"},
      // Godot and Unity
      {"wall_albedo.png", "base_color"},
      {"wall_orm.png", "roughness[g] metallic[b] ambient_occlusion[r]"},
      {"Wall_BaseMap.png", "base_color"},
      {"Wall_MaskMap.png", "~roughness[a] metallic[r] ambient_occlusion[g] mask_detail[b]"},
      {"Wall_MetallicSmoothness.png", "~roughness[a] metallic[r]"},
      // 3dtextures.me
      {"Brick_Wall_019_basecolor.jpg", "base_color"},
      {"Brick_Wall_019_ambientOcclusion.jpg", "ambient_occlusion"},
      {"Brick_Wall_019_OCC.jpg", "ambient_occlusion"},
      {"Brick_Wall_019_NORM.jpg", "normal"},
      {"Brick_Wall_019_SPEC.jpg", "specular"},
      // cgbookcase
      {"Asphalt01_4K_BaseColor.png", "base_color"},
      {"Asphalt01_4K_Height.png", "height"},
      // ShareTextures
      {"concrete_20_albedo-2K.jpg", "base_color"},
      {"concrete_20_normal-ogl-2K.png", "normal up"},
      {"concrete_20_metallic-2K.png", "metallic"},
      // FreePBR
      {"rustediron2_basecolor.png", "base_color"},
      {"bark1-normal3.png", "normal"},
      {"bark1-rough2.png", "roughness"},
      {"bark1_normal-ogl.png", "normal up"},
  };
  for (const auto& [name, map] : shipped) {
    CAPTURE(name);
    std::vector<std::string> maps;
    for (RecognisedMap m : recognise_maps(files({name})).maps) {
      m.file.clear();
      std::string text = shown(m);
      std::erase(text, '=');
      if (m.inverted) text = "~" + (text.erase(text.find('~'), 1));
      maps.push_back(text);
    }
    CHECK(fmt::format("{}", fmt::join(maps, " ")) == map);
  }
}

TEST_CASE("one file is judged by the last telling word of its name") {
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"red_normal_bricks_color.png", "base_color"},
      {"Height Map 01.png", "height"},
      {"rock-AOMap.png", "ambient_occlusion"},
      {"normalgl.png", "normal"},
      {"wallNormalDX_4096x4096.png", "normal"},
      {"GROUND_ALBEDO.TIF", "base_color"},
      {"ground_color_1001.exr", "base_color"},
      {"sand_depth.png", "height"},
      {"rough_wood_smoothness.png", "roughness"},
      {"rough_wood.png", ""},
      {"metal.png", "metallic"},
      {"photo.png", ""},
      {"texture_d.png", "base_color"},
      {"d.png", ""},
      {"wall_R8.png", ""},
  };
  for (const auto& [name, map] : cases) {
    CAPTURE(name);
    const std::vector<RecognisedMap> maps = recognise_map({.name = name, .size = {}});
    CHECK((maps.empty() ? "" : maps.front().map) == map);
  }
}

TEST_CASE("a packed name needs the channels it speaks of") {
  const auto maps_of = [](const char* name, int channels) {
    return shown(recognise_map({.name = name, .size = {}, .channels = channels}));
  };
  CHECK(maps_of("wall_metallicSmoothness.png", 3) == std::vector<std::string>{"metallic=wall_metallicSmoothness.png"});
  CHECK(maps_of("brushed_metallic_roughness.png", 1) ==
        std::vector<std::string>{"roughness=brushed_metallic_roughness.png"});
  CHECK(maps_of("brushed_metallic_roughness.png", 3).size() == 2);
  CHECK(maps_of("wall_metalRoughness.png", 1) == std::vector<std::string>{"roughness=wall_metalRoughness.png"});
  CHECK(maps_of("rock_nrm_rgh.png", 3) == std::vector<std::string>{"roughness=rock_nrm_rgh.png"});
}

TEST_CASE("of several files for one map the larger is taken, then the lossless one, and the notes say so") {
  Recognition r = recognise_maps({{.name = "rock_1k_height.png", .size = {1024, 1024}, .channels = 1},
                                  {.name = "rock_2k_height.jpg", .size = {2048, 2048}, .channels = 1}});
  CHECK(shown(r.maps) == std::vector<std::string>{"height=rock_2k_height.jpg"});
  CHECK(has_note(r, "height is rock_2k_height.jpg (2048x2048); rock_1k_height.png (1024x1024) left out"));

  r = recognise_maps(files({"rock_color.jpg", "rock_color.png", "rock_color.exr", "rock_color.tif"}));
  CHECK(shown(r.maps) == std::vector<std::string>{"base_color=rock_color.exr"});

  r = recognise_maps(files({"rock_color.png", "rock_NormalDX.png", "rock_NormalGL.png"}));
  CHECK(has_note(r, "normal is rock_NormalGL.png (OpenGL); rock_NormalDX.png (DirectX) left out"));
}

TEST_CASE("gloss stands in for roughness, inverted, only where there is no roughness") {
  const Recognition alone = recognise_maps(files({"rock_gloss.png"}));
  CHECK(shown(alone.maps) == std::vector<std::string>{"roughness=~rock_gloss.png"});
  CHECK(has_note(alone, "roughness is rock_gloss.png, inverted"));
  CHECK(shown(recognise_maps(files({"rock_gloss.png", "rock_roughness.png"})).maps) ==
        std::vector<std::string>{"roughness=rock_roughness.png"});
}

TEST_CASE("previews are left out, and the notes say why") {
  const Recognition r = recognise_maps(files({"rock_preview_color.png", "rock_mip2_normal.png", "rock_sphere.png"}));
  CHECK(r.maps.empty());
  CHECK(r.ignored.empty());
  CHECK(has_note(r, "rock_sphere.png left out: a picture of the material"));
  CHECK(has_note(r, "rock_mip2_normal.png left out: a level of a mip chain"));
}

TEST_CASE("of several levels of detail the finest that is there is taken") {
  struct Case {
    std::vector<std::string> names;
    std::string normal;
  };
  const std::vector<Case> cases = {
      {{"tg_4K_Albedo.jpg", "tg_4K_LOD0_Normal.jpg", "tg_4K_LOD1_Normal.jpg"}, "tg_4K_LOD0_Normal.jpg"},
      {{"tg_4K_Albedo.jpg", "tg_4K_Normal_LOD3.jpg", "tg_4K_Normal_LOD2.jpg"}, "tg_4K_Normal_LOD2.jpg"},
      {{"tg_Albedo_LOD_1.jpg", "tg_Normal_LOD_10.jpg", "tg_Normal_LOD_2.jpg"}, "tg_Normal_LOD_2.jpg"},
      {{"tgLOD2Albedo.jpg", "tgLOD2Normal.jpg"}, "tgLOD2Normal.jpg"},
      {{"tg_lod-1_albedo.jpg", "tg_normal.jpg", "tg_lod-1_normal.jpg"}, "tg_normal.jpg"},
  };
  for (const auto& [names, normal] : cases) {
    CAPTURE(normal);
    const Recognition r = recognise_maps(files(names));
    REQUIRE(r.maps.size() == 2);
    CHECK(r.materials.size() == 1);
    CHECK(r.maps[1].file == normal);
  }
  const Recognition r = recognise_maps(files({"tg_Normal_LOD3.jpg", "tg_Normal_LOD2.jpg"}));
  CHECK(has_note(r, "normal is tg_Normal_LOD2.jpg, level of detail 2: the folder holds no finer one"));
  CHECK(has_note(r, "tg_Normal_LOD3.jpg left out"));
  CHECK_FALSE(has_note(recognise_maps(files({"tg_Normal_LOD0.jpg"})), "level of detail"));
}

TEST_CASE("the order in which files are listed does not matter") {
  std::vector<MapFile> all = files({"a_color.png", "a_fine_normal.png", "a_normal.png", "a_orm.png", "a_ao.jpg"});
  const std::vector<std::string> first = shown(recognise_maps(all).maps);
  std::reverse(all.begin(), all.end());
  CHECK(shown(recognise_maps(all).maps) == first);
}

TEST_CASE("the known words are those that stand alone; letters that only end a name are not among them") {
  CHECK(known_words(Semantic::ambient_occlusion) == "ambientocclusion, occlusion, ao, mixedao, occ");
  CHECK(known_words(Semantic::base_color).find("bc") == std::string::npos);
}
