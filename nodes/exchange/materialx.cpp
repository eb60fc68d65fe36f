#include <pugixml.hpp>
#include <sstream>

#include <fmt/format.h>

#include "nodes/exchange/scene.h"

namespace terrazzo {

namespace {

/// A surface's input, and the map that feeds it.
struct Slot {
  const char* input;
  const char* type;
  const char* map;
};

struct ShaderInputs {
  const char* node;
  std::vector<Slot> slots;
  const char* opacity;  ///< the input for opacity, and its type
  const char* opacity_type;
  const char* glow;  ///< the input that scales emission
};

const ShaderInputs& surface_of(bool open_pbr) {
  static const ShaderInputs standard = {"standard_surface",
                                        {{"base_color", "color3", "base_color"},
                                         {"metalness", "float", "metallic"},
                                         {"specular_roughness", "float", "roughness"},
                                         {"emission_color", "color3", "emission"}},
                                        "opacity",
                                        "color3",
                                        "emission"};
  static const ShaderInputs open = {"open_pbr_surface",
                                    {{"base_color", "color3", "base_color"},
                                     {"base_metalness", "float", "metallic"},
                                     {"specular_roughness", "float", "roughness"},
                                     {"emission_color", "color3", "emission"}},
                                    "geometry_opacity",
                                    "float",
                                    "emission_luminance"};
  return open_pbr ? open : standard;
}

pugi::xml_node add(pugi::xml_node parent, const char* element, const std::string& name, const char* type) {
  pugi::xml_node node = parent.append_child(element);
  node.append_attribute("name") = name.c_str();
  node.append_attribute("type") = type;
  return node;
}

pugi::xml_node add_value(pugi::xml_node parent, const char* name, const char* type, const std::string& value) {
  pugi::xml_node input = add(parent, "input", name, type);
  input.append_attribute("value") = value.c_str();
  return input;
}

std::string pair_of(double x, double y) {
  return fmt::format("{:g}, {:g}", x, y);
}

class MaterialxWriter {
 public:
  MaterialxWriter(const MaterialScene& scene, bool open_pbr)
      : scene_(scene), surface_(surface_of(open_pbr)), name_(identifier(scene.name)) {}

  std::string text() {
    pugi::xml_node root = document_.append_child("materialx");
    root.append_attribute("version") = "1.38";
    root.append_attribute("colorspace") = "lin_rec709";
    graph_ = root.append_child("nodegraph");
    graph_.append_attribute("name") = ("NG_" + name_).c_str();
    shader_ = add(root, surface_.node, "SR_" + name_, "surfaceshader");
    for (const Slot& slot : surface_.slots)
      if (scene_.find(slot.map)) connect(slot.input, slot.type, image(slot.map, slot.type));
    if (scene_.find("emission")) add_value(shader_, surface_.glow, "float", "1");
    add_normal();
    add_opacity();
    const bool displaces = scene_.relief > 0 && scene_.find("height");
    if (displaces) add_displacement(root);
    pugi::xml_node material = add(root, "surfacematerial", name_, "material");
    add(material, "input", "surfaceshader", "surfaceshader").append_attribute("nodename") = ("SR_" + name_).c_str();
    if (displaces)
      add(material, "input", "displacementshader", "displacementshader").append_attribute("nodename") =
          ("DS_" + name_).c_str();
    std::ostringstream out;
    document_.save(out, "  ");
    return out.str();
  }

 private:
  /// Adds a node that reads a map; returns the node's name.
  std::string image(const char* map, const char* type) {
    const SceneFile& file = *scene_.find(map);
    std::string name = std::string(map) + "_image";
    pugi::xml_node node = add(graph_, "tiledimage", name, type);
    pugi::xml_node input = add_value(node, "file", "filename", file.name);
    // Colours declare their space; data must not, or readers convert it.
    const std::string& space = file.content->image->info().color_space;
    if (type == std::string_view("color3") && space != "raw") input.append_attribute("colorspace") = space.c_str();
    add_value(node, "uvtiling", "vector2", pair_of(scene_.repeats[0], scene_.repeats[1]));
    add_size(node, "realworldimagesize", scene_.metres);
    add_size(node, "realworldtilesize", scene_.metres);
    return name;
  }

  static void add_size(pugi::xml_node node, const char* name, PhysicalSize metres) {
    pugi::xml_node input = add_value(node, name, "vector2", pair_of(metres.width, metres.height));
    input.append_attribute("unittype") = "distance";
    input.append_attribute("unit") = "meter";
  }

  std::string through(const char* element, const std::string& name, const char* type, const char* from_type,
                      const std::string& from) {
    pugi::xml_node node = add(graph_, element, name, type);
    add(node, "input", "in", from_type).append_attribute("nodename") = from.c_str();
    return name;
  }

  std::string output(const std::string& name, const char* type, const std::string& from) {
    add(graph_, "output", name, type).append_attribute("nodename") = from.c_str();
    return name;
  }

  void connect(const char* input, const char* type, const std::string& from) {
    pugi::xml_node node = add(shader_, "input", input, type);
    node.append_attribute("nodegraph") = ("NG_" + name_).c_str();
    node.append_attribute("output") = output(std::string(input) + "_out", type, from).c_str();
  }

  void add_normal() {
    if (!scene_.find("normal")) return;
    const bool is_open = surface_.node == std::string_view("open_pbr_surface");
    connect(is_open ? "geometry_normal" : "normal", "vector3",
            through("normalmap", "normal_map", "vector3", "vector3", image("normal", "vector3")));
  }

  void add_opacity() {
    if (!scene_.find("opacity")) return;
    std::string from = image("opacity", "float");
    if (surface_.opacity_type == std::string_view("color3"))
      from = through("convert", "opacity_color", "color3", "float", from);
    connect(surface_.opacity, surface_.opacity_type, from);
  }

  void add_displacement(pugi::xml_node root) {
    pugi::xml_node node = add(root, "displacement", "DS_" + name_, "displacementshader");
    pugi::xml_node input = add(node, "input", "displacement", "float");
    input.append_attribute("nodegraph") = ("NG_" + name_).c_str();
    input.append_attribute("output") = output("height_out", "float", image("height", "float")).c_str();
    add_value(node, "scale", "float", fmt::format("{:g}", scene_.relief));
  }

  const MaterialScene& scene_;
  const ShaderInputs& surface_;
  std::string name_;
  pugi::xml_document document_;
  pugi::xml_node graph_, shader_;
};

}  // namespace

std::string materialx_text(const MaterialScene& scene, bool open_pbr) {
  return MaterialxWriter(scene, open_pbr).text();
}

}  // namespace terrazzo
