#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "nodes/exchange/scene.h"

namespace terrazzo {

namespace {

/// Written for Blender 2.8 to 4: inputs of the Principled BSDF have had several names.
constexpr std::string_view body = R"(
folder = os.path.dirname(os.path.abspath(bpy.path.abspath(__file__)))
material = bpy.data.materials.new(NAME)
material.use_nodes = True
nodes, links = material.node_tree.nodes, material.node_tree.links
surface = next(n for n in nodes if n.type == "BSDF_PRINCIPLED")
output = next(n for n in nodes if n.type == "OUTPUT_MATERIAL")
coordinates = nodes.new("ShaderNodeTexCoord")
mapping = nodes.new("ShaderNodeMapping")
mapping.inputs["Scale"].default_value = (REPEATS[0], REPEATS[1], 1)
links.new(coordinates.outputs["UV"], mapping.inputs["Vector"])


def image(map):
    node = nodes.new("ShaderNodeTexImage")
    node.label = map
    node.image = bpy.data.images.load(os.path.join(folder, FILES[map]["file"]))
    node.image.colorspace_settings.name = FILES[map]["color_space"]
    links.new(mapping.outputs["Vector"], node.inputs["Vector"])
    return node.outputs["Color"]


def connect(map, *names):
    if map not in FILES:
        return
    name = next(n for n in names if n in surface.inputs)
    links.new(image(map), surface.inputs[name])


connect("base_color", "Base Color")
connect("roughness", "Roughness")
connect("metallic", "Metallic")
connect("opacity", "Alpha")
connect("emission", "Emission Color", "Emission")
if "emission" in FILES and "Emission Strength" in surface.inputs:
    surface.inputs["Emission Strength"].default_value = 1
if "normal" in FILES:
    normal = nodes.new("ShaderNodeNormalMap")
    links.new(image("normal"), normal.inputs["Color"])
    links.new(normal.outputs["Normal"], surface.inputs["Normal"])
if "height" in FILES and RELIEF > 0:
    displacement = nodes.new("ShaderNodeDisplacement")
    displacement.inputs["Midlevel"].default_value = 0
    displacement.inputs["Scale"].default_value = RELIEF
    links.new(image("height"), displacement.inputs["Height"])
    links.new(displacement.outputs["Displacement"], output.inputs["Displacement"])

mesh = bpy.data.meshes.new(NAME)
x, y = SIZE[0] / 2, SIZE[1] / 2
mesh.from_pydata([(-x, -y, 0), (x, -y, 0), (x, y, 0), (-x, y, 0)], [], [(0, 1, 2, 3)])
mesh.uv_layers.new().data.foreach_set("uv", [0, 0, 1, 0, 1, 1, 0, 1])
mesh.materials.append(material)
bpy.context.collection.objects.link(bpy.data.objects.new(NAME, mesh))
)";

}  // namespace

std::string blender_script(const MaterialScene& scene) {
  nlohmann::ordered_json files = nlohmann::ordered_json::object();
  for (const char* map :
       {"base_color", "normal", "height", "roughness", "metallic", "opacity", "emission", "ambient_occlusion"})
    if (const SceneFile* file = scene.find_alone(map))
      files[map] = {{"file", file->name},
                    {"color_space", file->content->image->info().color_space == "srgb_texture" ? "sRGB" : "Non-Color"}};
  const auto text = [](const nlohmann::ordered_json& json) {
    return json.dump(-1, ' ', true, nlohmann::ordered_json::error_handler_t::replace);
  };
  const PhysicalSize plane = scene.plane();
  return fmt::format(
             "# Makes the material and a plane of its physical size: blender --python FILE, or open it in the text "
             "editor and run it.\nimport os\n\nimport bpy\n\nNAME = {}\nSIZE = ({:g}, {:g})  # metres\n"
             "REPEATS = ({:g}, {:g})\nRELIEF = {:g}  # metres from the lowest height to the highest\nFILES = {}\n",
             text(scene.name), plane.width, plane.height, scene.repeats[0], scene.repeats[1], scene.relief,
             text(files)) +
         std::string(body);
}

}  // namespace terrazzo
