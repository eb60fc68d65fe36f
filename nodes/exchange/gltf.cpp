#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/base/base64.h"
#include "core/base/text.h"
#include "nodes/exchange/scene.h"

namespace terrazzo {

namespace {

using nlohmann::ordered_json;
static_assert(std::endian::native == std::endian::little, "glTF buffers are little endian");

// The specification's numbers.
constexpr int component_float = 5126, component_short = 5123;
constexpr int array_buffer = 34962, element_array_buffer = 34963;
constexpr int linear = 9729, linear_mipmap_linear = 9987, repeat = 10497;

constexpr std::array<std::string_view, 6> gltf_maps = {"base_color",        "normal",  "roughness", "metallic",
                                                       "ambient_occlusion", "emission"};

/// An attribute of the plane's four corners, or its indices.
struct Part {
  const char* name;
  const char* type;
  int count;
  int components;
  std::string bytes;
};

template <typename T>
std::string bytes_of(const std::vector<T>& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
}

/// The upper left corner is (0, 0) of the texture, as in glTF: v points down, and so does -bitangent.
std::vector<Part> plane_parts(PhysicalSize size) {
  const auto x = float(size.width / 2), y = float(size.height / 2);
  std::vector<float> normals, tangents;
  for (int i = 0; i < 4; i++) {
    normals.insert(normals.end(), {0, 0, 1});
    tangents.insert(tangents.end(), {1, 0, 0, 1});
  }
  return {{"POSITION", "VEC3", 4, 3, bytes_of(std::vector<float>{-x, -y, 0, x, -y, 0, x, y, 0, -x, y, 0})},
          {"NORMAL", "VEC3", 4, 3, bytes_of(normals)},
          {"TANGENT", "VEC4", 4, 4, bytes_of(tangents)},
          {"TEXCOORD_0", "VEC2", 4, 2, bytes_of(std::vector<float>{0, 1, 1, 1, 1, 0, 0, 0})},
          {nullptr, "SCALAR", 6, 1, bytes_of(std::vector<uint16_t>{0, 1, 2, 0, 2, 3})}};
}

/// The name with characters escaped that a URI cannot hold.
std::string uri_of(const std::string& name) {
  std::string out;
  for (const char c : name) {
    if (is_word(c) || c == '.' || c == '-' || c == '~')
      out += c;
    else
      out += fmt::format("%{:02X}", static_cast<unsigned char>(c));
  }
  return out;
}

const char* mime_of(const std::string& file) {
  return file.ends_with(".png") ? "image/png" : "image/jpeg";
}

class Writer {
 public:
  explicit Writer(const MaterialScene& scene) : scene_(scene) {}

  /// `images`: bytes of the images to store in the buffer; null: they are files beside the document.
  ordered_json document(const std::vector<std::string>* images) {
    add_geometry();
    add_images(images);
    ordered_json json = {{"asset", {{"version", "2.0"}, {"generator", "terrazzo"}}}};
    if (is_tiled()) {
      json["extensionsUsed"] = {transform};
      json["extensionsRequired"] = {transform};
    }
    json["scene"] = 0;
    json["scenes"] = {{{"nodes", {0}}}};
    json["nodes"] = {{{"mesh", 0}, {"name", scene_.name}}};
    ordered_json primitive = {{"attributes", attributes_}, {"indices", indices_}, {"material", 0}};
    json["meshes"] = {{{"name", scene_.name}, {"primitives", {primitive}}}};
    json["materials"] = {material()};
    if (!textures_.empty()) {
      json["textures"] = textures_;
      json["images"] = images_;
      json["samplers"] = {
          {{"magFilter", linear}, {"minFilter", linear_mipmap_linear}, {"wrapS", repeat}, {"wrapT", repeat}}};
    }
    json["accessors"] = accessors_;
    json["bufferViews"] = views_;
    json["buffers"] = {{{"byteLength", buffer_.size()}}};
    return json;
  }
  const std::string& buffer() const { return buffer_; }

 private:
  static constexpr const char* transform = "KHR_texture_transform";

  bool is_tiled() const { return scene_.repeats != std::array{1.0, 1.0}; }

  int add_view(const std::string& bytes, int target) {
    buffer_.resize((buffer_.size() + 3) / 4 * 4);
    ordered_json view = {{"buffer", 0}, {"byteOffset", buffer_.size()}, {"byteLength", bytes.size()}};
    if (target) view["target"] = target;
    buffer_ += bytes;
    views_.push_back(std::move(view));
    return int(views_.size()) - 1;
  }

  void add_geometry() {
    const PhysicalSize plane = scene_.plane();
    for (const Part& p : plane_parts(plane)) {
      // Without a normal map nothing reads tangents.
      if (p.name && p.name == std::string_view("TANGENT") && !scene_.find("normal")) continue;
      const int view = add_view(p.bytes, p.name ? array_buffer : element_array_buffer);
      ordered_json accessor = {{"bufferView", view},
                               {"componentType", p.name ? component_float : component_short},
                               {"count", p.count},
                               {"type", p.type}};
      if (p.name && p.name == std::string_view("POSITION")) {
        const auto x = float(plane.width / 2), y = float(plane.height / 2);
        accessor["min"] = {-x, -y, 0.0f};
        accessor["max"] = {x, y, 0.0f};
      }
      accessors_.push_back(std::move(accessor));
      (p.name ? attributes_[p.name] : indices_) = int(accessors_.size()) - 1;
    }
  }

  void add_images(const std::vector<std::string>* images) {
    for (size_t i = 0; i < scene_.files.size(); i++) {
      const std::string& name = scene_.files[i].name;
      ordered_json image = {{"name", name}};
      if (images) {
        image["mimeType"] = mime_of(name);
        image["bufferView"] = add_view((*images)[i], 0);
      } else {
        image["uri"] = uri_of(name);
      }
      images_.push_back(std::move(image));
      textures_.push_back({{"sampler", 0}, {"source", i}});
    }
  }

  ordered_json texture(const SceneFile& file) const {
    ordered_json info = {{"index", &file - scene_.files.data()}};
    if (is_tiled()) info["extensions"][transform] = {{"scale", scene_.repeats}};
    return info;
  }

  ordered_json material() const {
    ordered_json pbr = ordered_json::object();
    ordered_json out = {{"name", scene_.name}};
    if (const SceneFile* colours = scene_.find("base_color")) {
      pbr["baseColorTexture"] = texture(*colours);
      if (colours->content->find("opacity")) {
        out["alphaMode"] = "MASK";
        out["alphaCutoff"] = 0.5;
      }
    }
    const SceneFile* orm = nullptr;
    for (const char* map : {"roughness", "metallic", "ambient_occlusion"})
      if (!orm) orm = scene_.find(map);
    if (orm) {
      pbr["metallicRoughnessTexture"] = texture(*orm);
    } else {
      pbr["metallicFactor"] = 0;
      pbr["roughnessFactor"] = 0.5;
    }
    out["pbrMetallicRoughness"] = std::move(pbr);
    if (const SceneFile* normals = scene_.find("normal")) out["normalTexture"] = texture(*normals);
    if (const SceneFile* occlusion = scene_.find("ambient_occlusion")) out["occlusionTexture"] = texture(*occlusion);
    if (const SceneFile* emission = scene_.find("emission")) {
      out["emissiveTexture"] = texture(*emission);
      out["emissiveFactor"] = {1, 1, 1};
    }
    return out;
  }

  const MaterialScene& scene_;
  std::string buffer_;
  ordered_json views_, accessors_, images_, textures_, attributes_, indices_;
};

std::string as_text(const ordered_json& json, int indent) {
  return json.dump(indent, ' ', false, ordered_json::error_handler_t::replace);
}

void add_number(std::string& out, uint32_t value) {
  out.append(reinterpret_cast<const char*>(&value), sizeof value);
}

/// A chunk of a binary file, padded to four bytes.
void add_chunk(std::string& out, const char* type, std::string bytes, char padding) {
  bytes.resize((bytes.size() + 3) / 4 * 4, padding);
  add_number(out, uint32_t(bytes.size()));
  out.append(type, 4);
  out += bytes;
}

}  // namespace

bool gltf_takes(const FileContent& file) {
  return std::ranges::any_of(gltf_maps, [&](std::string_view map) { return file.find(map) != nullptr; });
}

std::string gltf_text(const MaterialScene& scene) {
  Writer writer(scene);
  ordered_json json = writer.document(nullptr);
  json["buffers"][0]["uri"] =
      "data:application/octet-stream;base64," +
      base64({reinterpret_cast<const uint8_t*>(writer.buffer().data()), writer.buffer().size()});
  return as_text(json, 2) + "\n";
}

std::string glb_bytes(const MaterialScene& scene, const std::vector<std::string>& images) {
  Writer writer(scene);
  const std::string json = as_text(writer.document(&images), -1);
  std::string chunks;
  add_chunk(chunks, "JSON", json, ' ');
  add_chunk(chunks, "BIN\0", writer.buffer(), '\0');
  std::string out = "glTF";
  add_number(out, 2);
  add_number(out, uint32_t(out.size() + 4 + chunks.size()));
  return out + chunks;
}

}  // namespace terrazzo
