#include <algorithm>
#include <filesystem>

#include <doctest/doctest.h>

#include "core/image_io/image_file.h"
#include "nodes/common/registry.h"
#include "tests/odd_images.h"
#include "tests/run_node.h"
#include "tests/texts.h"

/// Maps in layers and alpha channels of other files.
using namespace terrazzo;
using namespace terrazzo::test;
namespace fs = std::filesystem;

namespace {

void write(const fs::path& path, int channels, const std::function<float(int, int, int)>& value) {
  write_image(*make_image({8, 8}, channels, value), path, {.format = *format_from(path)}, [](double) {});
}

void write_layers(const fs::path& path) {
  constexpr Size size{4, 4};
  std::vector<float> pixels;
  for (int i = 0; i < size.area(); i++)
    for (const float v : {0.1f, 0.2f, 0.3f, 0.5f, 0.5f, 1.0f, float(i) / 16}) pixels.push_back(v);
  write_odd(path,
            {.size = size,
             .channels = 7,
             .type = "float",
             .channel_names = {"basecolor.R", "basecolor.G", "basecolor.B", "normal_gl.X", "normal_gl.Y", "normal_gl.Z",
                               "height.Y"}},
            pixels);
}

}  // namespace

TEST_CASE("the layers of an EXR file are the maps of a material") {
  const TemporaryFolder folder;
  write_layers(folder.path() / "wall.exr");
  const NodeRun run = run_node("load_material", {{"path", folder.path().string()}});
  const MaterialPtr m = run.get<Material>("material");
  CHECK(m->map_names() == "base_color, normal, height");
  CHECK(m->find("base_color")->info().color_space == "lin_rec709");
  CHECK(m->find("base_color")->read({0, 0, 1, 1}) == std::vector<float>{0.1f, 0.2f, 0.3f});
  CHECK(m->find("height")->read({1, 1, 1, 1})[0] == 5.0f / 16);
  CHECK(m->find("normal")->info().normal_y == NormalY::up);
  CHECK(run.says("height: wall.exr (layer height)"));
}

TEST_CASE("files of a folder and layers make one material; the larger map counts") {
  const TemporaryFolder folder;
  write_layers(folder.path() / "wall.exr");
  write(folder.path() / "wall_height.png", 1, [](int x, int, int) { return float(x) / 8; });
  const NodeRun run = run_node("load_material", {{"path", folder.path().string()}});
  CHECK(run.get<Material>("material")->find("height")->size() == Size{8, 8});
  CHECK(run.says("height is wall_height.png (8x8); wall.exr (layer height) (4x4) left out"));
}

TEST_CASE("`maps` takes layers and their channels") {
  const TemporaryFolder folder;
  write_layers(folder.path() / "wall.exr");
  const auto error = [&](const char* source) {
    return error_of("load_material", {{"path", folder.path().string()}, {"maps", TextMap{{"roughness", source}}}});
  };
  const NodeRun run =
      run_node("load_material",
               {{"path", folder.path().string()},
                {"maps", TextMap{{"roughness", "wall.exr:basecolor.g"}, {"mask", "wall.exr:height"}, {"height", ""}}}});
  const MaterialPtr m = run.get<Material>("material");
  CHECK(m->map_names() == "base_color, normal, roughness, mask");
  CHECK(m->find("roughness")->read({0, 0, 1, 1}) == std::vector<float>{0.2f});
  CHECK(m->find("mask")->read({2, 0, 1, 1}) == std::vector<float>{2.0f / 16});
  CHECK(contains(error("wall.exr:hight"), "it has no layer \"hight\" (did you mean \"height\"?)"));
  CHECK(contains(error("wall.exr:height.g"), "which has only 1 channel"));
}

TEST_CASE("load_map reads one layer") {
  const TemporaryFolder folder;
  write_layers(folder.path() / "wall.exr");
  const std::string path = (folder.path() / "wall.exr").string();
  const NodeRun run = run_node("load_map", {{"path", path}, {"layer", "height"}, {"semantic", "height"}});
  CHECK(run.get<Image>("image")->channels() == 1);
  CHECK(contains(error_of("load_map", {{"path", path}}), "it holds the layers"));
  const Forecast seen =
      find_node_type("load_map")->preflight({{"path", path}, {"layer", "height"}, {"semantic", "height"}}, {});
  CHECK(seen.images.at("").size == Size{4, 4});
}

TEST_CASE("<UDIM> in `maps` is the tile that `name` picks") {
  const TemporaryFolder folder;
  for (const char* file : {"wall_color.1001.png", "wall_color.1002.png"})
    write(folder.path() / file, 3, [](int x, int, int c) { return float(x + c) / 16; });
  write(folder.path() / "extra.1002.png", 1, [](int, int y, int) { return float(y) / 8; });
  const Params params = {
      {"path", folder.path().string()}, {"name", "wall.1002"}, {"maps", TextMap{{"height", "extra.<UDIM>.png"}}}};
  const MaterialPtr m = run_node("load_material", params).get<Material>("material");
  CHECK(m->name() == "wall.1002");
  CHECK(m->map_names() == "base_color, height");
  Params none = params;
  none["name"] = "wall";
  CHECK(contains(error_of("load_material", none),
                 "<UDIM> stands for the tile that `name` picks, such as \"wall.1002\"; `name` is \"wall\""));
}

TEST_CASE("gloss in the alpha of a specular or metallic map is the roughness, unless there is another") {
  for (const char* name : {"wall_specular.png", "wall_metallic.png"}) {
    INFO(name);
    const TemporaryFolder folder;
    write(folder.path() / name, 4, [](int x, int, int c) { return c == 3 ? float(x) / 15 : 0.2f; });
    const std::string path = folder.path().string();
    const NodeRun run = run_node("load_material", {{"path", path}});
    const ImagePtr roughness = run.get<Material>("material")->find("roughness");
    REQUIRE(roughness);
    CHECK(roughness->read({3, 0, 1, 1})[0] == doctest::Approx(1 - 3.0 / 15));
    CHECK(run.says(std::string("roughness: ") + name + " (alpha channel), inverted: gloss"));
    write(folder.path() / "wall_roughness.png", 1, [](int, int, int) { return 0.4f; });
    CHECK(run_node("load_material", {{"path", path}}).says("is left out: there is a roughness map"));
    fs::remove(folder.path() / "wall_roughness.png");
    write(folder.path() / name, 4, [](int, int, int c) { return c == 3 ? 1.0f : 0.2f; });
    CHECK_FALSE(run_node("load_material", {{"path", path}}).get<Material>("material")->find("roughness"));
  }
  const TemporaryFolder folder;
  write(folder.path() / "wall_SpecularSmoothness.png", 4, [](int, int, int c) { return c == 3 ? 0.8f : 0.2f; });
  const NodeRun run = run_node("load_material", {{"path", folder.path().string()}});
  CHECK(run.get<Material>("material")->map_names() == "roughness, specular");
  CHECK(run.get<Material>("material")->find("roughness")->read({0, 0, 1, 1})[0] == doctest::Approx(0.2));
}

TEST_CASE("a MaskMap without a detail mask brings none") {
  const TemporaryFolder folder;
  const auto write_mask_map = [&](float detail) {
    write(folder.path() / "wall_MaskMap.png", 4,
          [=](int x, int y, int c) { return c == 2 ? detail * (x == 3 && y == 3 ? 0.4f : 0.5f) : float(x + c) / 16; });
  };
  const Params params = {{"path", folder.path().string()}};
  const auto maps = [](const NodeRun& run) { return run.get<Material>("material")->map_names(); };
  write_mask_map(1);
  CHECK(maps(run_node("load_material", params)) == "roughness, metallic, ambient_occlusion, mask_detail");
  write_mask_map(0);
  CHECK(maps(run_node("load_material", params)) == "roughness, metallic, ambient_occlusion");
  CHECK(run_node("load_material", params).says("mask_detail: wall_MaskMap.png (channel b) is the same everywhere"));
  Params all = params;
  all["maps"] = TextMap{{"mask_detail", "wall_MaskMap.png:b"}};
  CHECK(maps(run_node("load_material", all)) == "roughness, metallic, ambient_occlusion, mask_detail");
}

TEST_CASE("a packed file whose name says nothing is known by its pixels") {
  const auto pattern = run_node("pattern", {{"size", Size{128, 128}}}).get<Material>("material");
  const TemporaryFolder folder;
  for (const char* map : {"base_color", "height", "normal"})
    write_image(*pattern->find(map), folder.path() / ("wall_" + std::string(map) + ".png"), {}, [](double) {});
  const auto o = pattern->find("ambient_occlusion")->pixels(), r = pattern->find("roughness")->pixels();
  write_image(*make_image({128, 128}, 3,
                          [&](int x, int y, int c) {
                            const size_t i = size_t(y) * 128 + size_t(x);
                            return c == 0 ? o[i] : c == 1 ? r[i] : 0.0f;
                          }),
              folder.path() / "wall_extra.png", {}, [](double) {});
  const std::string path = folder.path().string();
  const NodeRun run = run_node("load_material", {{"path", path}});
  CHECK(run.get<Material>("material")->map_names() ==
        "base_color, normal, height, roughness, metallic, ambient_occlusion");
  CHECK(run.says("wall_extra.png: its name says no map; it is taken for ORM by its pixels"));
  CHECK_FALSE(run.says("ignored"));
  const Forecast seen =
      find_node_type("load_material")
          ->preflight(
              {{"path", path}, {"name", std::string()}, {"maps", TextMap{}}, {"ignore", Texts{}}, {"data", Texts{}}},
              {});
  CHECK(std::ranges::count(*seen.possible_maps, "roughness") == 1);
  CHECK(run_node("load_material", {{"path", path}, {"ignore", Texts{"*extra*"}}})
            .get<Material>("material")
            ->maps()
            .size() == 3);
  write_image(*pattern->find("roughness"), folder.path() / "wall_roughness.png", {}, [](double) {});
  CHECK(run_node("load_material", {{"path", path}}).says("ignored, the name says no map: wall_extra.png"));
}

TEST_CASE("alpha that the file says is none, or that is 0 everywhere, is no opacity; DDS is looked at") {
  const TemporaryFolder folder;
  const auto loaded = [&](const char* name) {
    const NodeRun run = run_node("load_material", {{"path", folder.path().string()}});
    INFO(name);
    CHECK(run.get<Material>("material")->map_names() == "base_color");
    CHECK(run.get<Material>("material")->find("base_color")->channels() == 3);
    return run;
  };
  write(folder.path() / "wall_basecolor.png", 4, [](int x, int, int c) { return c == 3 ? 0 : float(x) / 15; });
  CHECK(loaded("png").says("warning: wall_basecolor.png: its alpha is 0 everywhere, so that nothing would be seen"));
  fs::remove(folder.path() / "wall_basecolor.png");
  // 1x1, 32 bits, BI_RGB.
  Bytes bmp(58);
  for (const auto& [at, value] : {std::pair{0, 'B'},
                                  {1, 'M'},
                                  {2, char(58)},
                                  {10, char(54)},
                                  {14, char(40)},
                                  {18, char(1)},
                                  {22, char(1)},
                                  {26, char(1)},
                                  {28, char(32)},
                                  {54, char(10)}})
    bmp[size_t(at)] = uint8_t(value);
  write_bytes(folder.path() / "wall_basecolor.bmp", bmp);
  CHECK(loaded("bmp").says("wall_basecolor.bmp: the fourth byte of its pixels is unused"));
  fs::remove(folder.path() / "wall_basecolor.bmp");
  Bytes dds(136);  // 4x4 of DXT1, a cube map
  for (const auto& [at, value] : {std::pair{0, 'D'},
                                  {1, 'D'},
                                  {2, 'S'},
                                  {3, ' '},
                                  {4, char(124)},
                                  {8, char(7)},
                                  {9, char(0x10)},
                                  {12, char(4)},
                                  {16, char(4)},
                                  {76, char(32)},
                                  {80, char(4)},
                                  {84, 'D'},
                                  {85, 'X'},
                                  {86, 'T'},
                                  {87, '1'},
                                  {109, char(0x10)},
                                  {113, char(0xfe)}})
    dds[size_t(at)] = uint8_t(value);
  write_bytes(folder.path() / "wall_basecolor.dds", dds);
  CHECK(contains(error_of("load_material", {{"path", folder.path().string()}}),
                 "wall_basecolor.dds: it is a cube map; expected a flat picture"));
  dds[113] = 0;
  write_bytes(folder.path() / "wall_basecolor.dds", dds);
  CHECK(loaded("dds").says("base_color: wall_basecolor.dds"));
}
