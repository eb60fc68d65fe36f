#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "nodes/exchange/export_preset.h"
#include "tests/run_node.h"
#include "tests/texts.h"

using namespace terrazzo;
using namespace terrazzo::test;
using nlohmann::json;

namespace {

ImagePtr constant(Semantic semantic, const std::vector<float>& pixel, Size size = {8, 6}, Depth depth = Depth::u8) {
  const ImagePtr image = make_image(
      size, int(pixel.size()), [&](int, int, int c) { return pixel[size_t(c)]; }, semantic,
      semantic == Semantic::base_color || semantic == Semantic::emission ? "srgb_texture" : "raw");
  ImageInfo info = image->info();
  info.depth = depth;
  return Image::redescribed(image, info);
}

/// Each map with values of its own, so that one in the wrong channel is seen.
MaterialPtr material(std::vector<std::string> without = {}) {
  std::vector<Map> maps = {{"base_color", constant(Semantic::base_color, {0.1f, 0.2f, 0.3f})},
                           {"normal", constant(Semantic::normal, {0.5f, 0.6f, 0.9f})},
                           {"height", constant(Semantic::height, {0.35f})},
                           {"roughness", constant(Semantic::roughness, {0.7f}, {4, 3})},
                           {"metallic", constant(Semantic::metallic, {0.8f})},
                           {"ambient_occlusion", constant(Semantic::ambient_occlusion, {0.95f})},
                           {"opacity", constant(Semantic::opacity, {0.45f})},
                           {"data_cavity", constant(Semantic::data, {0.15f})}};
  std::erase_if(maps, [&](const Map& m) { return std::ranges::find(without, m.name) != without.end(); });
  return Material::make("wall", std::move(maps), {2, 1.5});
}

struct Files {
  std::vector<FileContent> all;
  std::vector<std::string> notes;

  std::vector<float> first_pixel(const std::string& name) const {
    for (const FileContent& f : all)
      if (f.name == name) {
        std::vector<float> pixel = f.image->read({f.image->width() - 1, 0, 1, 1});
        for (float& v : pixel) v = std::round(v * 100) / 100;
        return pixel;
      }
    return {};
  }
  const FileContent& at(const std::string& name) const {
    for (const FileContent& f : all)
      if (f.name == name) return f;
    FAIL("no file ", name);
    return all.front();
  }
};

Files files(const std::string& preset, const MaterialPtr& m = material()) {
  Files out;
  out.all = preset_files(*find_export_preset(preset), *m, "wall", out.notes);
  return out;
}

using Pixel = std::vector<float>;

}  // namespace

TEST_CASE("each engine gets its channels") {
  CHECK(files("unreal").first_pixel("T_wall_ORM") == Pixel{0.95f, 0.7f, 0.8f});
  CHECK(files("godot").first_pixel("wall_orm") == Pixel{0.95f, 0.7f, 0.8f});
  CHECK(files("gltf").first_pixel("wall_orm") == Pixel{0.95f, 0.7f, 0.8f});
  CHECK(files("unity_hdrp").first_pixel("wall_MaskMap") == Pixel{0.8f, 0.95f, 0.5f, 0.3f});
  CHECK(files("unity_urp").first_pixel("wall_MetallicOcclusionSmoothness") == Pixel{0.8f, 0.95f, 0, 0.3f});
}

TEST_CASE("green points down for Unreal and up for all others, whichever way it came") {
  for (const ExportPreset& p : export_presets())
    for (const NormalY came : {NormalY::up, NormalY::down}) {
      ImageInfo info = material()->find("normal")->info();
      info.normal_y = came;
      const Files f = files(std::string(p.name),
                            Material::make("wall", {{"normal", Image::redescribed(material()->find("normal"), info)}}));
      REQUIRE(f.all.size() == 1);
      const NormalY wanted = p.name == "unreal" ? NormalY::down : NormalY::up;
      CHECK(f.all[0].image->info().normal_y == wanted);
      CHECK(f.all[0].image->read({0, 0, 1, 1})[1] == doctest::Approx(came == wanted ? 0.6 : 0.4));
      CHECK(contains(described(f.all[0]), wanted == NormalY::up ? "green up (OpenGL)" : "green down (DirectX)"));
    }
}

TEST_CASE("opacity is the alpha of colours where the preset has it so") {
  CHECK(files("gltf").first_pixel("wall_base_color") == Pixel{0.1f, 0.2f, 0.3f, 0.45f});
  CHECK(files("gltf", material({"opacity"})).first_pixel("wall_base_color") == Pixel{0.1f, 0.2f, 0.3f});
  CHECK(files("unreal").first_pixel("T_wall_Opacity") == Pixel{0.45f});
  CHECK(contains(described(files("gltf").at("wall_base_color")), "alpha: opacity"));
}

TEST_CASE("what a material lacks is a constant, and what a preset does not take is a file of its own") {
  const Files f = files("unreal", material({"metallic", "ambient_occlusion"}));
  CHECK(f.first_pixel("T_wall_ORM") == Pixel{1, 0.7f, 0});
  CHECK(f.first_pixel("T_wall_data_cavity") == Pixel{0.15f});
  CHECK(f.notes.size() == 3);
  CHECK(contains(f.notes[0], "no ambient_occlusion, so channel r is 1"));
  CHECK(contains(f.notes[2], "data_cavity: no file of unreal has a place for it"));
  CHECK(files("unity_hdrp", material({"roughness"})).first_pixel("wall_MaskMap")[3] == 0.5f);
  const Files plain = files("unreal", material({"metallic", "ambient_occlusion", "roughness"}));
  CHECK(plain.first_pixel("T_wall_ORM").empty());
}

TEST_CASE("no map is lost in any preset") {
  for (const ExportPreset& p : export_presets()) {
    CAPTURE(p.name);
    const Files f = files(std::string(p.name));
    const MaterialPtr whole = material();
    for (const Map& m : whole->maps())
      CHECK(std::ranges::any_of(f.all, [&](const FileContent& c) { return c.find(m.name) != nullptr; }));
  }
}

TEST_CASE("data is raw, colours are sRGB, heights have at least 16 bits, and sizes are the largest map's") {
  for (const ExportPreset& p : export_presets()) {
    CAPTURE(p.name);
    for (const FileContent& c : files(std::string(p.name)).all) {
      CAPTURE(c.name);
      const ImageInfo& info = c.image->info();
      CHECK(info.color_space == (c.find("base_color") ? "srgb_texture" : "raw"));
      CHECK(info.depth == (c.find("height") ? Depth::u16 : Depth::u8));
      CHECK((info.size == Size{8, 6} || c.whole_map() == "roughness"));
    }
  }
}

TEST_CASE("metadata and sidecar say what is in each file") {
  const Files f = files("unity_hdrp");
  CHECK(metadata_line(f.at("wall_Normal"), {}) == "terrazzo: normal green=up color_space=raw");
  CHECK(metadata_line(f.at("wall_MaskMap"), {2, 1.5}) ==
        "terrazzo: metallic=r ambient_occlusion=g roughness=1-a color_space=raw metres=2x1.5");
  std::vector<std::pair<std::string, const FileContent*>> named;
  for (const FileContent& c : f.all) named.emplace_back(c.name + ".png", &c);
  const json sidecar = json::parse(sidecar_text(*find_export_preset("unity_hdrp"), "wall", {2, 1.5}, named));
  CHECK(sidecar["terrazzo_material"] == 1);
  CHECK(sidecar["metres"] == json{2, 1.5});
  const json& mask = sidecar["files"]["wall_MaskMap.png"];
  CHECK(mask["maps"] == json{{"metallic", "r"}, {"ambient_occlusion", "g"}, {"roughness", "a"}});
  CHECK(mask["inverted"] == json{"roughness"});
  CHECK(sidecar["files"]["wall_Normal.png"]["normal_y"] == "up");
  CHECK(sidecar["files"]["wall_BaseColor.png"]["maps"] == json{{"base_color", "rgb"}, {"opacity", "a"}});
}
