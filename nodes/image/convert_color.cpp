#include <fmt/format.h>

#include "core/image_io/color.h"
#include "nodes/common/color_space.h"
#include "nodes/common/node_helpers.h"
#include "nodes/common/shape_rules.h"

namespace terrazzo {

namespace {

void compute_convert_color(NodeContext& node) {
  ImagePtr image = node.input<Image>("image");
  ImageInfo info = image->info();
  const std::string& config = node.text("config");
  if (node.text("from") != "auto") info.color_space = color_space_of(node, "from", config);
  image = Image::redescribed(image, info);
  if (info.color_space == "raw") node.note("the image is raw and stays as it is; give \"from\" to convert it");
  node.output("image", convert_color(image, color_space_of(node, "to", config), config));
}

std::vector<std::string> check_convert_color(const Params& params) {
  const std::string& config = std::get<std::string>(params.at("config"));
  std::vector<std::string> problems = color_space_problems(params, "to", "", config);
  for (std::string& p : color_space_problems(params, "from", "auto", config)) problems.push_back(std::move(p));
  return problems;
}

bool is_data(Semantic semantic) {
  return semantic != Semantic::base_color && semantic != Semantic::emission && semantic != Semantic::specular;
}

}  // namespace

NodeType convert_color_node() {
  NodeType t;
  t.name = "convert_color";
  t.category = "image";
  t.summary = "Converts an image to another colour space";
  t.help =
      "Uses OpenColorIO. The built-in configuration has srgb_texture, lin_rec709, acescg and raw; $OCIO, or a "
      "configuration given here, replaces it. Results are made again when the configuration, a look-up file that it "
      "names or a variable of the environment that it uses changes. Raw images are data and are never converted. Alpha "
      "stays as it is. Pixels are computed on demand.";
  t.inputs = {image_port("image", "the image")};
  t.outputs = {image_port("image", "the image in the new colour space")};
  t.params = {
      {.name = "to", .type = ParamType::text, .fallback = "lin_rec709", .help = "The colour space to convert to."},
      {.name = "from",
       .type = ParamType::text,
       .fallback = "auto",
       .help = "The image's colour space; auto takes the one the image declares. Set it if that is wrong."},
      {.name = "config",
       .type = ParamType::path,
       .fallback = "",
       .help = "An OpenColorIO configuration file; empty for $OCIO or the built-in one."}};
  t.persist = Persist::digest;
  t.files_read = [](const Params& params) { return color_config_files(std::get<std::string>(params.at("config"))); };
  t.check = check_convert_color;
  t.lint = [](const Params&, const InputForecasts& inputs) {
    const std::optional<Semantic> semantic = image_at(inputs, "image").semantic;
    return semantic && is_data(*semantic)
               ? Lints{{fmt::format(
                     "\"image\": a {} map holds {}, not colours; another colour space makes no sense of them",
                     name_of(*semantic), *semantic == Semantic::normal ? "directions" : "values")}}
               : Lints{};
  };
  t.infer = [](const Params&, const InputForecasts& inputs) {
    ImageFacts image = image_at(inputs, "image");
    image.color_space.reset();  // its name is the configuration's
    return OutputForecasts{{"image", forecast_of_image(image)}};
  };
  t.compute = compute_convert_color;
  return t;
}

}  // namespace terrazzo
