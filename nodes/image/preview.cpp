#include "core/picture/render/preview.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/image_io/color.h"
#include "core/material/map_names.h"
#include "core/node/node.h"
#include "nodes/common/shape_rules.h"

namespace terrazzo {

namespace {

/// A plane preview with another aspect ratio than the material repeats or crops it, which is unexpected unless the
/// number of repeats was set.
void note_other_shape(NodeContext& node, const PreviewSpec& spec, Size material) {
  if (spec.shape != PreviewShape::plane || spec.tilt != 0 || spec.tile != 1) return;
  const int whole = std::max(1, int(std::lround(double(spec.size.width) * material.height / material.width)));
  if (std::abs(whole - spec.size.height) <= 1) return;
  node.note(
      fmt::format("the material ({}) and the picture ({}) differ in aspect ratio: the material fills the width once "
                  "and the height {:.2f} times; a size of {} shows exactly one",
                  describe(material), describe(spec.size), double(spec.size.height) / whole,
                  describe(Size{spec.size.width, whole})));
}

PreviewShape shape_of(const Params& params) {
  return std::get<std::string>(params.at("shape")) == "sphere" ? PreviewShape::sphere : PreviewShape::plane;
}

Size size_of(const Params& params, Size material) {
  return completed(std::get<Size>(params.at("size")), shape_of(params), material);
}

Size size_of(const NodeContext& node) {
  return size_of(node.params(), node.input<Material>("material")->size());
}

OutputForecasts infer_preview(const Params& params, const InputForecasts& inputs) {
  const std::optional<Size> material = material_size(inputs.at("material").front());
  ImageFacts picture{.channels = 3, .semantic = Semantic::base_color};
  const bool is_one = std::get<Numbers>(params.at("lights")).size() < 2;
  if (is_one && material) picture.size = size_of(params, *material);
  return {{"image", forecast_of_image(picture)}};
}

void compute_preview(NodeContext& node) {
  PreviewSpec s;
  s.shape = shape_of(node.params());
  s.size = size_of(node);
  s.lights = node.numbers("lights");
  if (s.lights.empty()) s.lights = {node.number("azimuth")};
  s.elevation = node.number("elevation");
  s.intensity = node.number("intensity");
  s.ambient = node.number("ambient");
  s.exposure = node.number("exposure");
  s.relief = node.number("relief");
  s.tile = node.number("repeats");
  s.tilt = node.number("tilt");
  s.distance = node.number("distance");
  std::copy_n(node.numbers("background").begin(), 3, s.background);
  const MaterialPtr material = node.input<Material>("material");
  note_other_shape(node, s, material->size());
  node.output("image", render_preview(*material, s, node.task()));
}

Param number(std::string name, double fallback, double min, double max, std::string unit, std::string help) {
  return {.name = std::move(name),
          .type = ParamType::number,
          .fallback = fallback,
          .help = std::move(help),
          .min = min,
          .max = max,
          .unit = std::move(unit)};
}

std::vector<Param> preview_params() {
  return {
      {.name = "shape",
       .type = ParamType::choice,
       .fallback = "plane",
       .help = "plane: seen from above, one texel per pixel if the sizes match. sphere: wrapped around a ball.",
       .choices = {"plane", "sphere"}},
      {.name = "size",
       .type = ParamType::size,
       .fallback = Size{512, 512},
       .help = "Size of the picture; with several lights, of each one. On a plane the material fills the width, and "
               "repeats or is cut off below if aspect ratios differ; a note says so. 0 for one side takes the "
               "material's proportions: [512, 0].",
       .min = 0,
       .max = largest_preview,
       .unit = "pixels"},
      number("azimuth", 135, -360, 360, "degrees",
             "Direction the light comes from: 0 right, 90 top, 180 left, 270 bottom."),
      number("elevation", 40, 0, 90, "degrees", "Height of the light above the picture plane: 0 grazing, 90 frontal."),
      {.name = "lights",
       .type = ParamType::numbers,
       .fallback = Numbers{},
       .help = "Several azimuths, one picture each on a sheet, row by row; replaces azimuth.",
       .min = -360,
       .max = 360,
       .unit = "degrees",
       .max_count = 64},
      number("intensity", 1, 0, 100, "", "Brightness of the light; at 1 a white surface that faces it is white."),
      number("ambient", 0.25, 0, 100, "", "Brightness of the uniform surroundings; more lightens shadows."),
      number("exposure", 0, -10, 10, "stops", "Brightness of the whole picture; +1 doubles it."),
      number("relief", 1, 0, 20, "", "Depth of parallax and shadows relative to the normals; 0 switches them off."),
      number("repeats", 1, 0.01, 64, "", "Repeats of the material across the picture, or across the side of the ball."),
      number("tilt", 0, 0, 75, "degrees", "Plane only: how far it tilts back."),
      number("distance", 4, 1.1, 100, "radii",
             "Sphere only: distance of the camera from the centre. More makes the ball smaller."),
      {.name = "background",
       .type = ParamType::numbers,
       .fallback = Numbers{0.12, 0.12, 0.13},
       .help = "Behind the ball: red, green, blue in sRGB.",
       .min = 0,
       .max = 1,
       .min_count = 3,
       .max_count = 3},
  };
}

}  // namespace

NodeType preview_node() {
  NodeType t;
  t.name = "preview";
  t.version = 4;
  t.category = "image";
  t.summary = "Renders a material under a movable light";
  t.help =
      "GGX reflection (Walter et al. 2007, Heitz 2014) with normal mapping in either convention, ambient occlusion, "
      "metals, emission, and parallax and shadows ray-marched through the height map. The depth of the relief is "
      "estimated from the normals; without a normal map it is a twentieth of the material's width, and normals come "
      "from the height. Seen from above, heights that do not tile throw no shadows from one repeat onto the next. "
      "Render several lights "
      "to check that maps agree: bumps must be bright on the side of the light.";
  t.inputs = {{.name = "material", .type = ValueType::material, .help = "any maps; missing ones get defaults"}};
  t.outputs = {{.name = "image", .type = ValueType::image, .help = "8-bit colour picture"}};
  t.params = preview_params();
  t.persist = Persist::payload;
  t.files_read = [](const Params&) { return color_config_files(); };
  t.memory_hint = [](const NodeContext& node) {
    // The pictures and their sheet, and at most four texels per pixel of one picture, of 13 channels.
    const size_t area = size_t(size_of(node).area());
    return area * std::max<size_t>(1, node.numbers("lights").size()) * 6 * sizeof(float) +
           area * 4 * 13 * sizeof(float);
  };
  t.check = [](const Params& params) {
    const bool is_nothing = std::get<Size>(params.at("size")) == Size{0, 0};
    return is_nothing ? Texts{"\"size\": expected at most one side of 0, found two"} : Texts{};
  };
  t.infer = infer_preview;
  t.compute = compute_preview;
  return t;
}

}  // namespace terrazzo
