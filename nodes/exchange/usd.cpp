#include <fmt/format.h>

#include "nodes/exchange/scene.h"

namespace terrazzo {

namespace {

/// An input of UsdPreviewSurface, and the map that feeds it.
struct UsdSlot {
  const char* input;
  const char* type;
  const char* map;
  const char* output;  ///< of the texture
};
constexpr UsdSlot slots[] = {
    {"diffuseColor", "color3f", "base_color", "rgb"}, {"normal", "normal3f", "normal", "rgb"},
    {"roughness", "float", "roughness", "r"},         {"metallic", "float", "metallic", "r"},
    {"occlusion", "float", "ambient_occlusion", "r"}, {"opacity", "float", "opacity", "r"},
    {"emissiveColor", "color3f", "emission", "rgb"},  {"displacement", "float", "height", "r"},
};

std::string type_of(const UsdSlot& slot) {
  return std::string_view(slot.output) == "rgb" ? "float3" : "float";
}

class UsdWriter {
 public:
  explicit UsdWriter(const MaterialScene& scene) : scene_(scene), name_(identifier(scene.name)) {}

  std::string text() const {
    return fmt::format(
        "#usda 1.0\n(\n    defaultPrim = \"{0}\"\n    metersPerUnit = 1\n    upAxis = \"Y\"\n)\n\n"
        "def Xform \"{0}\"\n{{\n{1}\n{2}}}\n",
        name_, plane(), material());
  }

 private:
  bool is_used(const UsdSlot& slot) const {
    return scene_.find_alone(slot.map) && (slot.input != std::string_view("displacement") || scene_.relief > 0);
  }

  /// Texture coordinates begin at the lower left, where v is 0.
  std::string plane() const {
    const PhysicalSize size = scene_.plane();
    const double x = size.width / 2, y = size.height / 2;
    return fmt::format(
        R"(    def Mesh "Plane" (
        prepend apiSchemas = ["MaterialBindingAPI"]
    )
    {{
        float3[] extent = [({0:g}, {1:g}, 0), ({2:g}, {3:g}, 0)]
        int[] faceVertexCounts = [4]
        int[] faceVertexIndices = [0, 1, 2, 3]
        normal3f[] normals = [(0, 0, 1), (0, 0, 1), (0, 0, 1), (0, 0, 1)] (
            interpolation = "vertex"
        )
        point3f[] points = [({0:g}, {1:g}, 0), ({2:g}, {1:g}, 0), ({2:g}, {3:g}, 0), ({0:g}, {3:g}, 0)]
        texCoord2f[] primvars:st = [(0, 0), ({4:g}, 0), ({4:g}, {5:g}), (0, {5:g})] (
            interpolation = "vertex"
        )
        uniform token subdivisionScheme = "none"
        rel material:binding = </{6}/Material>
    }}
)",
        -x, -y, x, y, scene_.repeats[0], scene_.repeats[1], name_);
  }

  std::string material() const {
    const std::string path = fmt::format("/{}/Material", name_);
    std::string inputs, textures;
    for (const UsdSlot& slot : slots) {
      if (!is_used(slot)) continue;
      inputs += fmt::format("            {} inputs:{}.connect = <{}/{}.outputs:{}>\n", slot.type, slot.input, path,
                            slot.map, slot.output);
      textures += texture(slot, path);
    }
    return fmt::format(
        R"(    def Material "Material"
    {{
        token outputs:surface.connect = <{0}/Surface.outputs:surface>
{3}
        def Shader "Surface"
        {{
            uniform token info:id = "UsdPreviewSurface"
{1}{4}            int inputs:useSpecularWorkflow = 0
            token outputs:surface
            token outputs:displacement
        }}

        def Shader "Coordinates"
        {{
            uniform token info:id = "UsdPrimvarReader_float2"
            string inputs:varname = "st"
            float2 outputs:result
        }}
{2}    }}
)",
        path, inputs, textures,
        scene_.relief > 0
            ? fmt::format("        token outputs:displacement.connect = <{}/Surface.outputs:displacement>\n", path)
            : "",
        scene_.find_alone("opacity") ? "            float inputs:opacityThreshold = 0.5\n" : "");
  }

  std::string texture(const UsdSlot& slot, const std::string& path) const {
    const SceneFile& file = *scene_.find_alone(slot.map);
    const bool is_colour = file.content->image->info().color_space == "srgb_texture";
    std::string more;
    // Values of 0..1 become vectors.
    if (slot.map == std::string_view("normal"))
      more = "            float4 inputs:scale = (2, 2, 2, 1)\n            float4 inputs:bias = (-1, -1, -1, 0)\n";
    if (slot.map == std::string_view("height"))
      more = fmt::format("            float4 inputs:scale = ({0:g}, {0:g}, {0:g}, 1)\n", scene_.relief);
    return fmt::format(
        R"(
        def Shader "{}"
        {{
            uniform token info:id = "UsdUVTexture"
            asset inputs:file = @./{}@
            float2 inputs:st.connect = <{}/Coordinates.outputs:result>
            token inputs:sourceColorSpace = "{}"
            token inputs:wrapS = "repeat"
            token inputs:wrapT = "repeat"
{}            {} outputs:{}
        }}
)",
        slot.map, file.name, path, is_colour ? "sRGB" : "raw", more, type_of(slot), slot.output);
  }

  const MaterialScene& scene_;
  std::string name_;
};

}  // namespace

std::string usd_text(const MaterialScene& scene) {
  return UsdWriter(scene).text();
}

}  // namespace terrazzo
