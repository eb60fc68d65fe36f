#include "nodes/exchange/export_preset.h"

#include <filesystem>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "core/image/image_file.h"
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
