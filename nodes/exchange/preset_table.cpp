#include <algorithm>

#include "nodes/exchange/export_preset.h"

namespace terrazzo {

namespace {

/// Colour, with opacity as alpha if the material has it.
PresetFile colour(std::string_view suffix) {
  return {suffix, {{"base_color", 0}, {"base_color", 1}, {"base_color", 2}, {"opacity"}}, {"base_color"}};
}

PresetFile three(std::string_view suffix, std::string_view map) {
  return {suffix, {{map, 0}, {map, 1}, {map, 2}}, {map}};
}

PresetFile one(std::string_view suffix, std::string_view map) {
  return {suffix, {{map}}, {map}};
}

/// Values for missing maps: no occlusion, roughness 0.5, no metal.
constexpr ChannelSource occlusion{.map = "ambient_occlusion", .otherwise = 1};
constexpr ChannelSource roughness{.map = "roughness", .otherwise = 0.5};
constexpr ChannelSource metallic{.map = "metallic", .otherwise = 0};
constexpr ChannelSource smoothness{.map = "roughness", .inverted = true, .otherwise = 0.5};
const std::vector<std::string_view> surface = {"ambient_occlusion", "roughness", "metallic"};

/// One file per map, for documents that name each of them.
std::vector<PresetFile> separate() {
  return {three("_base_color", "base_color"), three("_normal", "normal"),   one("_roughness", "roughness"),
          one("_metallic", "metallic"),       one("_opacity", "opacity"),   three("_emission", "emission"),
          one("_height", "height"),           one("_specular", "specular"), one("_occlusion", "ambient_occlusion")};
}

std::vector<PresetFile> gltf_files() {
  return {colour("_base_color"),
          three("_normal", "normal"),
          {"_orm", {occlusion, roughness, metallic}, surface},
          three("_emission", "emission")};
}

std::vector<ExportPreset> table() {
  return {
      {"maps", "every map in a file of its own; normals green up", NormalY::up, {}},
      {"unreal",
       "T_ files for Unreal Engine: ORM, normals green down",
       NormalY::down,
       {three("_BaseColor", "base_color"),
        three("_Normal", "normal"),
        {"_ORM", {occlusion, roughness, metallic}, surface},
        one("_Height", "height"),
        one("_Opacity", "opacity"),
        three("_Emissive", "emission")}},
      {"unity_hdrp",
       "Unity's HDRP: MaskMap of metallic, occlusion, detail and smoothness; normals green up",
       NormalY::up,
       {colour("_BaseColor"),
        three("_Normal", "normal"),
        {"_MaskMap", {metallic, occlusion, {.otherwise = 0.5}, smoothness}, surface},
        one("_Height", "height"),
        three("_Emissive", "emission")}},
      {"unity_urp",
       "Unity's URP: metallic, occlusion and, in alpha, smoothness; normals green up",
       NormalY::up,
       {colour("_BaseMap"),
        three("_Normal", "normal"),
        {"_MetallicOcclusionSmoothness", {metallic, occlusion, {.otherwise = 0}, smoothness}, surface},
        one("_Height", "height"),
        three("_Emission", "emission")}},
      {"godot",
       "Godot: ORM, normals green up",
       NormalY::up,
       {colour("_albedo"),
        three("_normal", "normal"),
        {"_orm", {occlusion, roughness, metallic}, surface},
        one("_height", "height"),
        three("_emission", "emission")}},
      {"blender", "Blender: separate maps, and a script that makes the material", NormalY::up, separate(),
       PresetDocument::blender},
      {"gltf", "glTF 2.0: the material on a plane of its physical size, files beside it", NormalY::up, gltf_files(),
       PresetDocument::gltf},
      {"glb", "glTF 2.0 in one binary file", NormalY::up, gltf_files(), PresetDocument::glb},
      {"materialx", "MaterialX 1.38 with standard_surface", NormalY::up, separate(),
       PresetDocument::materialx_standard_surface},
      {"materialx_openpbr", "MaterialX with open_pbr_surface", NormalY::up, separate(),
       PresetDocument::materialx_open_pbr},
      {"usd", "USD: UsdPreviewSurface on a plane of the material's physical size", NormalY::up, separate(),
       PresetDocument::usd},
  };
}

}  // namespace

const std::vector<ExportPreset>& export_presets() {
  static const std::vector<ExportPreset> all = table();
  return all;
}

const ExportPreset* find_export_preset(std::string_view name) {
  const auto at = std::ranges::find(export_presets(), name, &ExportPreset::name);
  return at == export_presets().end() ? nullptr : &*at;
}

}  // namespace terrazzo
