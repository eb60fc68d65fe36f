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

TEST_CASE("float files hold linear colours") {
  const TemporaryFolder folder;
  run(folder.path(), {{"preset", std::string("maps")}, {"format", std::string("exr")}});
  const nlohmann::json json = nlohmann::json::parse(read_text(folder.path() / "terrazzo-material.json"));
  CHECK(json["files"]["wall_base_color.exr"]["color_space"] == "lin_rec709");
}
