#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "nodes/exchange/scene.h"

namespace terrazzo {

namespace {

constexpr std::string_view plane_maker = R"(

folder = os.path.dirname(os.path.abspath(bpy.path.abspath(__file__)))
material = build_material(NAME, folder, FILES, REPEATS, RELIEF)
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
  const PhysicalSize size = scene.plane();
  return fmt::format(
             "# Makes the material and a plane of its physical size: blender --python FILE, or open it in the text "
             "editor and run it.\nNAME = {}\nSIZE = ({:g}, {:g})  # metres\n"
             "REPEATS = ({:g}, {:g})\nRELIEF = {:g}  # metres from the lowest height to the highest\nFILES = {}\n\n",
             text(scene.name), size.width, size.height, scene.repeats[0], scene.repeats[1], scene.relief, text(files)) +
         std::string(blender_material_builder()) + std::string(plane_maker);
}

}  // namespace terrazzo
