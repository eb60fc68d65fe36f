#include "nodes/source/maps/material_sidecar.h"

#include <fstream>

#include <doctest/doctest.h>

#include "core/base/error.h"
#include "core/image_io/image_file.h"
#include "nodes/common/registry.h"
#include "tests/run_node.h"

using namespace terrazzo;
using namespace terrazzo::test;
namespace fs = std::filesystem;

namespace {

/// A folder with a few maps and a sidecar.
struct Export {
  TemporaryFolder folder;
  const fs::path& path = folder.path();

  Export() {
    for (const char* name : {"normal.png", "orm.png", "odd.png", "old_color.png"}) write(name, 3);
    write("mask.png", 4);
  }
  void write(const std::string& name, int channels) const {
    const auto value = [](int x, int y, int c) { return float((x * 5 + y * 3 + c * 40) % 256) / 255.0f; };
    write_image(*make_image({16, 16}, channels, value), path / name, {}, [](double) {});
  }
  void say(const std::string& text) const { std::ofstream(path / sidecar_name()) << text; }
  NodeRun load(Params params = {}) const {
    params["path"] = path.string();
    return run_node("load_material", params);
  }
  /// What is wrong with the sidecar, without its path.
  std::string complaint() const {
    try {
      read_sidecar(path);
      return "";
    } catch (const Error& e) {
      CHECK(e.about() == "path");
      const std::string text = e.what(), name = (path / sidecar_name()).string();
      CHECK(text.starts_with(name + ": "));
      return text.substr(name.size() + 2);
    }
  }
};

const char* const full_text = R"({"terrazzo_material": 1, "name": "bricks", "preset": "unreal", "metres": [2.0, 1.5],
  "files": {"normal.png": {"maps": {"normal": "rgb"}, "normal_y": "down", "color_space": "raw"},
            "mask.png": {"maps": {"metallic": "r", "roughness": "a"}, "inverted": ["roughness"]},
            "orm.png": {"maps": {"ambient_occlusion": "r", "roughness": "g"}, "later": 1},
            "odd.png": {"maps": {"base_color": "rgb"}, "color_space": "lin_rec709"}}})";

}  // namespace

TEST_CASE("a sidecar says what the files are, and counts more than their names") {
  const Export e;
  e.say(full_text);
  const NodeRun run = e.load();
  const MaterialPtr m = run.get<Material>("material");
  CHECK(m->name() == "bricks");
  CHECK(m->map_names() == "base_color, normal, roughness, metallic, ambient_occlusion");
  CHECK(m->find("base_color")->info().color_space == "lin_rec709");
  CHECK(m->find("normal")->info().normal_y == NormalY::down);
  CHECK(m->find("roughness")->channels() == 1);
  CHECK(m->find("roughness")->read({0, 0, 1, 1})[0] == 40.0f / 255);
  CHECK(run.says("roughness is orm.png (channel g); mask.png (channel a) left out"));
  CHECK(run.says("left out, terrazzo-material.json does not name them: old_color.png. `maps` takes them in"));
  CHECK(e.load({{"maps", TextMap{{"base_color", "old_color.png"}, {"normal", ""}}}})
            .get<Material>("material")
            ->map_names() == "base_color, roughness, metallic, ambient_occlusion");
  const NodeRun inverted = e.load({{"ignore", Texts{"orm*"}}});
  CHECK(inverted.get<Material>("material")->find("roughness")->read({0, 0, 1, 1})[0] == 1 - 120.0f / 255);
  CHECK(e.load({{"name", "old"}}).says("base_color: old_color.png"));
  CHECK(read_sidecar(e.path)->metres == PhysicalSize{2, 1.5});
}

TEST_CASE("a change of the sidecar is a change of the files that are read") {
  const Export e;
  const NodeType* type = find_node_type("load_material");
  const Params params = {{"path", e.path.string()}, {"maps", TextMap{}}};
  const size_t before = type->files_read(params).size();
  e.say(full_text);
  CHECK(type->files_read(params).size() == before + 1);
}

TEST_CASE("a wrong sidecar is refused with what is wrong and where") {
  const Export e;
  const auto with_files = [](const std::string& files) {
    return R"({"terrazzo_material": 1, "files": )" + files + "}";
  };
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"[", "it is no JSON: "},
      {"[]", "expected an object, found []"},
      {"{}", "expected \"terrazzo_material\": 1, the version of its format"},
      {R"({"terrazzo_material": 2})", "\"terrazzo_material\": format 2 is not known, this program reads 1"},
      {R"({"terrazzo_material": 1})", "expected \"files\" with an object for each file"},
      {R"({"terrazzo_material": 1, "name": 3})", "\"name\": expected a text, found 3"},
      {R"({"terrazzo_material": 1, "metres": [1]})", "\"metres\": expected two numbers above 0, width and height"},
      {with_files(R"({"gone.png": {"maps": {"height": "r"}}})"),
       "\"files\": \"gone.png\": the folder has no such file; put it back, or take it out of terrazzo-material.json"},
      {with_files(R"({"../orm.png": {"maps": {"height": "r"}}})"), "expected the name of a file in the folder"},
      {with_files(R"({"orm.png": {}})"), "\"orm.png\": expected \"maps\" with the channels of each map"},
      {with_files(R"({"orm.png": {"maps": {"roughnes": "g"}}})"),
       "\"orm.png\": \"maps\": \"roughnes\": there is no map of that name (did you mean \"roughness\"?)"},
      {with_files(R"({"orm.png": {"maps": {"roughness": "green"}}})"),
       "expected channels such as \"rgb\" or \"g\", found \"green\""},
      {with_files(R"({"orm.png": {"maps": {"roughness": 1}}})"), "expected channels such as \"rgb\" or \"g\", found 1"},
      {with_files(R"({"orm.png": {"maps": {"roughness": "g"}, "inverted": ["height"]}})"),
       "\"inverted\": \"height\" is none of the maps of this file"},
      {with_files(R"({"orm.png": {"maps": {"normal": "rgb"}, "normal_y": "gl"}})"),
       "\"normal_y\": expected \"up\" or \"down\", found \"gl\""},
      {with_files(R"({"orm.png": {"maps": {"normal": "rgb"}, "color_space": "srbg"}})"),
       "\"color_space\": there is no colour space \"srbg\""},
  };
  for (const auto& [text, message] : cases) {
    CAPTURE(text);
    e.say(text);
    const std::string complaint = e.complaint();
    CHECK_MESSAGE(complaint.find(message) != std::string::npos, complaint);
  }
  e.say(with_files(R"({"orm.png": {"maps": {"opacity": "a"}}})"));
  CHECK(error_of("load_material", {{"path", e.path.string()}}) ==
        "maps: opacity should be channel a of orm.png, which has only 3 channels");
}

TEST_CASE("what a file says of itself counts more than its name") {
  const TemporaryFolder folder;
  for (const char* name : {"wall_nor_gl.png", "wall_color.tif", "wall_result.exr"}) {
    const std::string text = std::string(name) == "wall_nor_gl.png" ? "terrazzo: normal green=down color_space=raw"
                             : std::string(name) == "wall_color.tif"
                                 ? "seed 7\nterrazzo: base_color color_space=lin_rec709"
                                 : "terrazzo: height color_space=raw";
    const ImagePtr image = make_image({16, 16}, 3, [](int x, int y, int c) { return float((x * y + c) % 7) / 8; });
    const FileFormat format = *format_from(name);
    write_image(*image, folder.path() / name,
                {.format = format, .depth = format == FileFormat::exr ? Depth::f32 : Depth::u8, .description = text},
                [](double) {});
    CHECK(read_image_info(folder.path() / name).description == text);
  }
  const MaterialPtr m = run_node("load_material", {{"path", folder.path().string()}}).get<Material>("material");
  CHECK(m->map_names() == "base_color, normal, height");
  CHECK(m->find("base_color")->info().color_space == "lin_rec709");
  CHECK(m->find("normal")->info().normal_y == NormalY::down);
}
