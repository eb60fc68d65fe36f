#include "nodes/exchange/export_preset.h"

#include <filesystem>

#include <doctest/doctest.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/image_io/image_file.h"
#include "nodes/common/registry.h"
#include "tests/run_node.h"
#include "tests/texts.h"

using namespace terrazzo;
using namespace terrazzo::test;
namespace fs = std::filesystem;

namespace {

MaterialPtr wall(PhysicalSize metres = {}) {
  const auto map = [](Semantic s, int channels, const std::string& space = "raw") {
    return make_image(
        {8, 4}, channels, [&](int x, int y, int c) { return float((x * 9 + y * 4 + c * 31) % 256) / 255.0f; }, s,
        space);
  };
  return Material::make("wall",
                        {{"base_color", map(Semantic::base_color, 3, "srgb_texture")},
                         {"normal", map(Semantic::normal, 3)},
                         {"height", map(Semantic::height, 1)},
                         {"roughness", map(Semantic::roughness, 1)}},
                        metres);
}

Params with_defaults(Params given) {
  for (const Param& p : find_node_type("export_preset")->params)
    if (p.fallback) given.try_emplace(p.name, *p.fallback);
  return given;
}

NodeRun run(const fs::path& folder, Params params, const MaterialPtr& m = wall()) {
  params["path"] = folder.string();
  return run_node("export_preset", params, {{"material", {m}}});
}

}  // namespace

TEST_CASE("every preset writes its files in every format that it takes") {
  for (const ExportPreset& p : export_presets())
    for (const char* format : {"png", "tif", "exr", "jpg", "tga"}) {
      CAPTURE(p.name);
      CAPTURE(format);
      const TemporaryFolder folder;
      const Params params = {{"preset", std::string(p.name)}, {"format", std::string(format)}};
      const std::string error = error_of("export_preset",
                                         [&] {
                                           Params all = params;
                                           all["path"] = folder.path().string();
                                           return all;
                                         }(),
                                         {{"material", {wall()}}});
      if (!error.empty()) {
        CHECK(contains(error, "format"));
        continue;
      }
      size_t images = 0;
      for (const auto& f : fs::directory_iterator(folder.path())) {
        if (f.path().extension() != "." + std::string(format)) continue;
        images++;
        CHECK(read_image_info(f.path()).size == Size{8, 4});
      }
      CHECK(images >= (p.name == "glb" ? 1 : 4));
    }
}

TEST_CASE("notes say which convention was written") {
  const TemporaryFolder folder;
  const NodeRun r = run(folder.path(), {{"preset", std::string("unreal")}, {"name", std::string("my wall")}});
  CHECK(r.says("T_my_wall_Normal.png: normals, green down (DirectX), not sRGB"));
  CHECK(r.says("T_my_wall_ORM.png: red: 1, green: roughness, blue: 0; not sRGB"));
  CHECK(fs::exists(folder.path() / "terrazzo-material.json"));
  CHECK(fs::exists(folder.path() / "T_my_wall_BaseColor.png"));
}

TEST_CASE("the physical size comes from the parameter, else the material, and is told if it is assumed") {
  const TemporaryFolder folder;
  const auto metres = [&](const Params& params, const MaterialPtr& m) {
    Params all = params;
    all["preset"] = std::string("usd");
    const NodeRun r = run(folder.path(), all, m);
    const nlohmann::json json = nlohmann::json::parse(read_text(folder.path() / "terrazzo-material.json"));
    const bool assumed = r.says("1 m in width is assumed");
    CHECK(assumed == !json.contains("metres"));
    return json.value("metres", std::vector<double>{});
  };
  CHECK(metres({}, wall()).empty());
  CHECK(metres({}, wall({3, 1.5})) == std::vector<double>{3, 1.5});
  CHECK(metres({{"metres", Numbers{4}}}, wall({3, 1.5})) == std::vector<double>{4, 2});
  CHECK(metres({{"metres", Numbers{4, 5}}}, wall()) == std::vector<double>{4, 5});
}

TEST_CASE("a binary glTF holds its images; what it does not take lies beside it") {
  const TemporaryFolder folder;
  run(folder.path(), {{"preset", std::string("glb")}});
  CHECK(listing(folder.path()) == std::vector<std::string>{"terrazzo-material.json", "wall.glb", "wall_height.png"});
  CHECK(fs::file_size(folder.path() / "wall.glb") > 1000);
}

TEST_CASE("the images in a binary glTF have the quality and the depth asked for") {
  const TemporaryFolder folder;
  const auto size = [&](const char* format, int64_t quality, const char* depth) {
    run(folder.path(), {{"preset", "glb"}, {"format", format}, {"jpeg_quality", quality}, {"depth", depth}});
    return fs::file_size(folder.path() / "wall.glb");
  };
  CHECK(size("jpg", 10, "keep") < size("jpg", 95, "keep"));
  CHECK(size("png", 95, "uint8") < size("png", 95, "uint16"));
}

TEST_CASE("mip levels show nothing of what lies under transparent pixels, in every preset and format") {
  const Size size{32, 32};
  const auto is_leaf = [](int x, int y) { return (x - 13) * (x - 13) + (y - 17) * (y - 17) < 60; };
  const MaterialPtr leaf = Material::make(
      "leaf", {{"base_color", make_image(
                                  size, 3, [&](int x, int y, int c) { return is_leaf(x, y) ? 0.2f * float(c) : 1.0f; },
                                  Semantic::base_color, "srgb_texture")},
               {"opacity", make_image(
                               size, 1, [&](int x, int y, int) { return float(is_leaf(x, y)); }, Semantic::opacity)}});
  for (const ExportPreset& p : export_presets())
    for (const char* format : {"png", "tif", "exr", "tga"}) {
      const Params params = {{"preset", std::string(p.name)},
                             {"format", std::string(format)},
                             {"mips", true},
                             {"depth", format == std::string("exr") ? "float" : "keep"},
                             {"path", std::string()}};
      const bool takes_format = find_node_type("export_preset")->check(with_defaults(params)).empty();
      if (p.document == PresetDocument::glb || !takes_format) continue;
      CAPTURE(p.name);
      CAPTURE(format);
      const TemporaryFolder folder;
      CHECK(run(folder.path(), params, leaf).says("colours count by their opacity in mip levels"));
      int levels = 0;
      for (const auto& f : fs::directory_iterator(folder.path())) {
        if (f.path().string().find(".mip") == std::string::npos) continue;
        const ImagePtr level = read_image(f.path(), {}, [](const std::string&) {});
        if (level->channels() < 3) continue;
        levels++;
        const std::vector<float> pixels = level->pixels();
        for (size_t i = 0; i < pixels.size(); i += size_t(level->channels())) CHECK(pixels[i] < 0.01f);
      }
      CHECK(levels == 5);
    }
}

TEST_CASE("what a format certainly cannot hold is refused before anything runs, whatever the preset") {
  const NodeType& type = *find_node_type("export_preset");
  const auto refusal = [&](std::string_view preset, const char* format, const std::vector<std::string>& maps) {
    Params params = with_defaults({{"preset", std::string(preset)}, {"format", std::string(format)}, {"path", "out"}});
    Forecast material;
    material.maps = maps;
    try {
      type.infer(params, {{"material", {material}}});
    } catch (const Error& e) {
      return fmt::format("{}: {}", e.about(), e.what());
    }
    return std::string();
  };
  for (const char* preset : {"gltf", "glb", "unity_hdrp", "unity_urp", "godot"}) {
    CAPTURE(preset);
    const std::string said = refusal(preset, "jpg", {"base_color", "opacity"});
    CHECK(contains(said, "format: "));
    CHECK(contains(said, "alpha channel (colours, sRGB; alpha: opacity), which JPEG does not have; take png"));
    CHECK(refusal(preset, "jpg", {"base_color"}).empty());
    CHECK(refusal(preset, "png", {"base_color", "opacity"}).empty());
    CHECK(refusal(preset, "jpg", {}).empty());
  }
  for (const char* preset : {"unreal", "usd", "materialx", "blender", "maps"})
    CHECK(refusal(preset, "jpg", {"base_color", "opacity", "roughness"}).empty());
  CHECK(contains(refusal("unity_hdrp", "jpg", {"base_color", "roughness"}), "format: "));
  CHECK(contains(refusal("unity_urp", "jpg", {"base_color", "metallic"}), "format: "));
}

TEST_CASE("what an earlier export wrote and this one does not is told, and not taken for current") {
  const auto without = [](std::string_view map) {
    std::vector<Map> maps = wall()->maps();
    std::erase_if(maps, [&](const Map& m) { return m.name == map; });
    return Material::make("wall", maps);
  };
  const auto maps_in = [](const fs::path& folder) {
    return run_node("load_material", {{"path", folder.string()}}).get<Material>("material")->map_names();
  };
  const TemporaryFolder maps;
  CHECK_FALSE(run(maps.path(), {{"mips", true}}).says("earlier export"));
  const NodeRun fewer = run(maps.path(), {}, without("height"));
  CHECK(
      fewer.says("still holds wall_base_color.mip1.png, wall_base_color.mip2.png, wall_base_color.mip3.png, "
                 "wall_height.mip1.png"));
  CHECK(fewer.says("wall_height.png"));
  CHECK(maps_in(maps.path()) == "base_color, normal, roughness");
  CHECK_FALSE(run(maps.path(), {{"mips", true}}).says("earlier export"));
  CHECK_FALSE(run(maps.path(), {{"name", "other"}}).says("earlier export"));

  const TemporaryFolder binary;
  run(binary.path(), {{"preset", "glb"}});
  CHECK(run(binary.path(), {{"preset", "glb"}}, without("height")).says("still holds wall_height.png of an earlier"));
  CHECK(contains(error_of("load_material", {{"path", binary.path().string()}}), "one binary file"));
  CHECK_FALSE(run(binary.path(), {{"preset", "glb"}}).says("earlier export"));
  CHECK(maps_in(binary.path()) == "height");
}

TEST_CASE("float files hold linear colours") {
  const TemporaryFolder folder;
  run(folder.path(), {{"preset", std::string("maps")}, {"format", std::string("exr")}});
  const nlohmann::json json = nlohmann::json::parse(read_text(folder.path() / "terrazzo-material.json"));
  CHECK(json["files"]["wall_base_color.exr"]["color_space"] == "lin_rec709");
}

TEST_CASE("what a preset wrote is read back as it was, by the sidecar") {
  const auto map = [](Semantic s, int channels, int step, const std::string& space = "raw") {
    const ImagePtr image = make_image(
        {8, 4}, channels, [&](int x, int y, int c) { return float((x * step + y * 40 + c * 31) % 256) / 255.0f; }, s,
        space);
    ImageInfo info = image->info();
    info.depth = Depth::u8;
    return Image::redescribed(image, info);
  };
  const MaterialPtr full = Material::make("wall",
                                          {{"base_color", map(Semantic::base_color, 3, 9, "srgb_texture")},
                                           {"normal", map(Semantic::normal, 3, 5)},
                                           {"height", map(Semantic::height, 1, 11)},
                                           {"roughness", map(Semantic::roughness, 1, 7)},
                                           {"metallic", map(Semantic::metallic, 1, 17)},
                                           {"ambient_occlusion", map(Semantic::ambient_occlusion, 1, 13)},
                                           {"opacity", map(Semantic::opacity, 1, 3)},
                                           {"emission", map(Semantic::emission, 3, 19, "srgb_texture")},
                                           {"data_cavity", map(Semantic::data, 1, 23)}},
                                          {3, 1.5});
  for (const ExportPreset& p : export_presets()) {
    if (p.document == PresetDocument::glb) continue;  // holds its images
    CAPTURE(p.name);
    const TemporaryFolder folder;
    run(folder.path(), {{"preset", std::string(p.name)}}, full);
    const auto back = run_node("load_material", {{"path", folder.path().string()}}).get<Material>("material");
    CHECK(back->metres() == full->metres());
    CHECK(back->maps().size() == full->maps().size());
    for (const Map& m : full->maps()) {
      CAPTURE(m.name);
      const ImagePtr image = back->find(m.name);
      REQUIRE(image);
      CHECK(image->info().color_space == m.image->info().color_space);
      if (m.name == "normal") CHECK(image->info().normal_y == p.normal_y);
      const std::vector<float> was = m.image->pixels(), is = image->pixels();
      REQUIRE(is.size() == was.size());
      for (size_t i = 0; i < is.size(); i++) {
        const bool is_flipped = m.name == "normal" && i % 3 == 1 && p.normal_y == NormalY::down;
        CHECK(is[i] == doctest::Approx(is_flipped ? 1 - was[i] : was[i]).epsilon(1e-4));
      }
    }
  }
}
