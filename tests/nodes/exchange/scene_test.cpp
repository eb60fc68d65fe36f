#include "nodes/exchange/scene.h"

#include <cmath>
#include <cstring>
#include <pugixml.hpp>
#include <set>

#include <doctest/doctest.h>
#include <nlohmann/json.hpp>

#include "tests/run_node.h"
#include "tests/texts.h"

using namespace terrazzo;
using namespace terrazzo::test;
using nlohmann::json;

namespace {

struct Example {
  std::vector<FileContent> contents;
  MaterialScene scene;

  explicit Example(const std::string& preset, bool is_full = true) {
    const auto map = [](Semantic s, int channels) {
      return make_image(
          {4, 4}, channels, [](int, int, int) { return 0.5f; }, s,
          s == Semantic::base_color || s == Semantic::emission ? "srgb_texture" : "raw");
    };
    std::vector<Map> maps = {{"base_color", map(Semantic::base_color, 3)}, {"normal", map(Semantic::normal, 3)}};
    if (is_full)
      for (const auto& [name, semantic, channels] :
           {std::tuple("roughness", Semantic::roughness, 1), std::tuple("metallic", Semantic::metallic, 1),
            std::tuple("ambient_occlusion", Semantic::ambient_occlusion, 1), std::tuple("height", Semantic::height, 1),
            std::tuple("opacity", Semantic::opacity, 1), std::tuple("emission", Semantic::emission, 3)})
        maps.push_back({name, map(semantic, channels)});
    std::vector<std::string> notes;
    contents = preset_files(*find_export_preset(preset), *Material::make("m", maps), "m", notes);
    scene = {.name = "red wall", .metres = {2, 1.5}};
    for (const FileContent& c : contents)
      if (preset != "gltf" || gltf_takes(c)) scene.files.push_back({c.name + ".png", &c});
  }
};

std::vector<float> floats_of(const std::string& buffer, const json& gltf, int accessor) {
  const json& view = gltf["bufferViews"][gltf["accessors"][accessor]["bufferView"].get<size_t>()];
  std::vector<float> out(view["byteLength"].get<size_t>() / 4);
  std::memcpy(out.data(), buffer.data() + view["byteOffset"].get<size_t>(), out.size() * 4);
  return out;
}

struct Chunks {
  json document;
  std::string buffer;
};

Chunks chunks_of(const std::string& glb) {
  const auto number = [&](size_t at) {
    uint32_t v = 0;
    std::memcpy(&v, glb.data() + at, 4);
    return v;
  };
  REQUIRE(glb.substr(0, 4) == "glTF");
  CHECK(number(4) == 2);
  CHECK(number(8) == glb.size());
  const size_t length = number(12);
  CHECK(length % 4 == 0);
  CHECK(glb.substr(16, 4) == "JSON");
  CHECK(number(20 + length) % 4 == 0);
  return {json::parse(glb.substr(20, length)), glb.substr(28 + length)};
}

}  // namespace

TEST_CASE("glTF connects every texture to the input that its channels are for") {
  const Example e("gltf");
  const json gltf = json::parse(gltf_text(e.scene));
  const json& m = gltf["materials"][0];
  const auto file = [&](const json& texture) {
    return gltf["images"][gltf["textures"][texture["index"].get<size_t>()]["source"].get<size_t>()]["uri"];
  };
  CHECK(file(m["pbrMetallicRoughness"]["baseColorTexture"]) == "m_base_color.png");
  CHECK(file(m["pbrMetallicRoughness"]["metallicRoughnessTexture"]) == "m_orm.png");
  CHECK(file(m["occlusionTexture"]) == "m_orm.png");
  CHECK(file(m["normalTexture"]) == "m_normal.png");
  CHECK(file(m["emissiveTexture"]) == "m_emission.png");
  CHECK(m["emissiveFactor"] == json{1, 1, 1});
  CHECK(m["alphaMode"] == "MASK");
  CHECK(gltf["images"].size() == 4);
  CHECK(gltf["samplers"][0]["wrapS"] == 10497);
  CHECK(gltf["samplers"][0]["minFilter"] == 9987);
  CHECK_FALSE(gltf.contains("extensionsUsed"));
}

TEST_CASE("glTF materials without maps have factors") {
  const Example e("gltf", false);
  const json gltf = json::parse(gltf_text(e.scene));
  const json& m = gltf["materials"][0];
  CHECK(m["pbrMetallicRoughness"]["metallicFactor"] == 0);
  CHECK_FALSE(m.contains("occlusionTexture"));
  CHECK_FALSE(m.contains("alphaMode"));
}

TEST_CASE("the plane of glTF has its physical size, and tangents whose bitangents point against v") {
  Example e("gltf");
  e.scene.repeats = {3, 2};
  const Chunks glb = chunks_of(glb_bytes(e.scene, std::vector<std::string>(e.scene.files.size(), "abc")));
  const json& a = glb.document["meshes"][0]["primitives"][0]["attributes"];
  const auto at = [&](const char* name) { return floats_of(glb.buffer, glb.document, a[name]); };
  const std::vector<float> p = at("POSITION"), n = at("NORMAL"), t = at("TANGENT"), uv = at("TEXCOORD_0");
  CHECK(p[3] - p[0] == doctest::Approx(6));  // three times two metres
  CHECK(p[10] - p[1] == doctest::Approx(3));
  for (int i = 0; i < 4; i++) {
    // bitangent = cross(N, T) * w
    const float bx = (n[i * 3 + 1] * t[i * 4 + 2] - n[i * 3 + 2] * t[i * 4 + 1]) * t[i * 4 + 3];
    const float by = (n[i * 3 + 2] * t[i * 4] - n[i * 3] * t[i * 4 + 2]) * t[i * 4 + 3];
    CHECK(bx == 0);
    CHECK(by == 1);
    // u grows along the tangent, v against the bitangent.
    CHECK(uv[i * 2] == (p[i * 3] > 0 ? 1 : 0));
    CHECK(uv[i * 2 + 1] == (p[i * 3 + 1] > 0 ? 0 : 1));
  }
  CHECK(glb.document["extensionsRequired"] == json{"KHR_texture_transform"});
  const json& colours = glb.document["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"];
  CHECK(colours["extensions"]["KHR_texture_transform"]["scale"] == json{3, 2});
  const json& image = glb.document["bufferViews"][glb.document["images"][1]["bufferView"].get<size_t>()];
  CHECK(glb.buffer.substr(image["byteOffset"], image["byteLength"]) == "abc");
}

TEST_CASE("MaterialX: one colour space for all, and its own only on colours") {
  for (const bool open : {false, true}) {
    Example e("materialx");
    e.scene.relief = 0.02;
    pugi::xml_document x;
    REQUIRE(x.load_string(materialx_text(e.scene, open).c_str()));
    const pugi::xml_node root = x.child("materialx");
    CHECK(std::string(root.attribute("version").value()) == "1.38");
    CHECK(std::string(root.attribute("colorspace").value()) == "lin_rec709");
    int images = 0;
    for (const pugi::xml_node node : root.child("nodegraph").children("tiledimage")) {
      images++;
      const bool is_colour = std::string_view(node.attribute("type").value()) == "color3";
      const pugi::xml_node file = node.find_child_by_attribute("name", "file");
      CHECK(std::string(file.attribute("colorspace").value()) == (is_colour ? "srgb_texture" : ""));
      CHECK(std::string(node.find_child_by_attribute("name", "realworldimagesize").attribute("value").value()) ==
            "2, 1.5");
    }
    CHECK(images == 7);
    const pugi::xml_node shader = root.child(open ? "open_pbr_surface" : "standard_surface");
    const auto source = [&](const char* input) {
      const pugi::xml_node in = shader.find_child_by_attribute("name", input);
      const pugi::xml_node graph = root.find_child_by_attribute("nodegraph", "name", in.attribute("nodegraph").value());
      const pugi::xml_node out = graph.find_child_by_attribute("output", "name", in.attribute("output").value());
      CHECK(std::string(out.attribute("type").value()) == in.attribute("type").value());
      return std::string(out.attribute("nodename").value());
    };
    CHECK(source("base_color") == "base_color_image");
    CHECK(source("specular_roughness") == "roughness_image");
    CHECK(source(open ? "base_metalness" : "metalness") == "metallic_image");
    CHECK(source(open ? "geometry_normal" : "normal") == "normal_map");
    CHECK(source(open ? "geometry_opacity" : "opacity") == (open ? "opacity_image" : "opacity_color"));
    CHECK(root.child("displacement"));
  }
}

TEST_CASE("MaterialX without relief has no displacement, which some readers do not know") {
  const Example e("materialx");
  CHECK_FALSE(contains(materialx_text(e.scene, false), "displacement"));
}

TEST_CASE("USD: every texture repeats and says its colour space, and normals are scaled to vectors") {
  Example e("usd");
  e.scene.repeats = {2, 3};
  const std::string usd = usd_text(e.scene);
  size_t textures = 0, spaces = 0;
  for (size_t at = usd.find("\"UsdUVTexture\""); at != usd.npos; at = usd.find("\"UsdUVTexture\"", at + 1)) {
    const std::string shader = usd.substr(at, usd.find('}', at) - at);
    textures++;
    CHECK(contains(shader, "wrapS = \"repeat\""));
    CHECK(contains(shader, "wrapT = \"repeat\""));
    const bool is_colour = contains(shader, "base_color.png") || contains(shader, "emission.png");
    CHECK(contains(shader, is_colour ? "sourceColorSpace = \"sRGB\"" : "sourceColorSpace = \"raw\""));
    spaces += contains(shader, "sourceColorSpace");
    CHECK(contains(shader, "scale = (2, 2, 2, 1)") == contains(shader, "normal.png"));
    CHECK(contains(shader, "bias = (-1, -1, -1, 0)") == contains(shader, "normal.png"));
  }
  CHECK(textures == 7);
  CHECK(spaces == textures);
  CHECK(contains(usd, "texCoord2f[] primvars:st = [(0, 0), (2, 0), (2, 3), (0, 3)]"));
  CHECK(contains(usd, "(-2, -2.25, 0)"));
  CHECK(contains(usd, "metersPerUnit = 1"));
  CHECK(contains(usd, "def Xform \"red_wall\""));
  CHECK_FALSE(contains(usd, "displacement.connect"));
  size_t depth = 0;
  for (const char c : usd) depth += c == '{' ? 1 : c == '}' ? -1 : 0;
  CHECK(depth == 0);
}

TEST_CASE("Blender's script loads data as data, and the height into Height") {
  Example e("blender");
  e.scene.relief = 0.1;
  const std::string script = blender_script(e.scene);
  CHECK(contains(script, "\"m_normal.png\",\"color_space\":\"Non-Color\""));
  CHECK(contains(script, "\"m_base_color.png\",\"color_space\":\"sRGB\""));
  CHECK(contains(script, "links.new(image(\"height\"), displacement.inputs[\"Height\"])"));
  CHECK(contains(script, "RELIEF = 0.1"));
  CHECK(contains(script, std::string(blender_material_builder())));
}

TEST_CASE("names become identifiers") {
  CHECK(identifier("red wall-2") == "red_wall_2");
  CHECK(identifier("2k") == "m_2k");
  CHECK(identifier("") == "m_");
}
