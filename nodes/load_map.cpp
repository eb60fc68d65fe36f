#include "core/image_file.h"
#include "core/node.h"

namespace terrazzo {

namespace {

std::vector<std::string> semantic_choices() {
  return {semantic_names.begin(), semantic_names.end()};
}

void compute(NodeContext& node) {
  ImageInfo info;
  info.semantic = *semantic_from(node.text("semantic"));
  info.normal_y = node.text("normal_y") == "down" ? NormalY::down : NormalY::up;
  info.color_space = node.text("color_space");
  if (info.color_space == "auto") {
    const bool is_color = info.semantic == Semantic::base_color || info.semantic == Semantic::emission ||
                          info.semantic == Semantic::specular;
    const bool is_float = read_image_info(node.text("path")).depth >= Depth::f16;
    info.color_space = !is_color ? "raw" : is_float ? "lin_rec709" : "srgb_texture";
  }
  node.output("image", read_image(node.text("path"), info, [&](const std::string& warning) { node.note(warning); }));
}

}  // namespace

NodeType load_map_node() {
  NodeType t;
  t.name = "load_map";
  t.category = "source";
  t.summary = "Reads one image file as a map";
  t.help =
      "Reads PNG, TIFF, EXR, JPEG and whatever else OpenImageIO reads. Pixels stay as they are in the file; semantic, "
      "colour space and normal convention say how later nodes read them.";
  t.outputs = {{.name = "image", .type = ValueType::image, .help = "the map"}};
  t.params = {
      {.name = "path", .type = ParamType::path, .help = "The image file."},
      {.name = "semantic",
       .type = ParamType::choice,
       .fallback = "base_color",
       .help = "What the map means; decides how it is weighted, filtered and written.",
       .choices = semantic_choices()},
      {.name = "color_space",
       .type = ParamType::text,
       .fallback = "auto",
       .help =
           "A colour space of the configuration. \"auto\": srgb_texture for colours in 8 and 16 bit, lin_rec709 for "
           "colours in float files, raw for everything else."},
      {.name = "normal_y",
       .type = ParamType::choice,
       .fallback = "up",
       .help = "Green channel of a normal map: up as in OpenGL, down as in DirectX.",
       .choices = {"up", "down"}},
  };
  t.persist = Persist::digest;
  t.files_read = [](const Params& p) {
    return std::vector<std::filesystem::path>{std::get<std::string>(p.at("path"))};
  };
  t.compute = compute;
  return t;
}

}  // namespace terrazzo
