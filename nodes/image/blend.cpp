#include <algorithm>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/filter/composite.h"
#include "core/image/image_facts.h"
#include "core/image/pixel_space.h"
#include "nodes/common/node_helpers.h"
#include "nodes/common/shape_rules.h"

namespace terrazzo {

namespace {

/// In the order of BlendMode.
const std::vector<std::string> mode_names = {"normal",   "multiply",   "screen", "overlay", "add",
                                             "subtract", "difference", "min",    "max"};

bool is_normal_map(const ImageFacts& image) {
  return image.semantic == Semantic::normal;
}

void require_alike(const ImageFacts& base, const ImageFacts& top) {
  if (!base.semantic || !top.semantic) return;
  const std::string found = fmt::format("{} over {}", describe(top), describe(base));
  if (is_normal_map(base) != is_normal_map(top))
    throw Error("top", "expected normals over normals or values over values, found " + found);
  if (is_normal_map(base) && std::min(base.channels.value_or(3), top.channels.value_or(3)) < 3)
    throw Error("top", "expected normals of 3 channels, found " + found);
}

void require_channels(const ImageFacts& base, const ImageFacts& top) {
  if (is_normal_map(base) || !base.channels || !top.channels) return;
  if (!base.semantic && std::min(*base.channels, *top.channels) >= 3) return;  // they may be normals
  if (*top.channels != 1 && *top.channels != *base.channels)
    throw Error("top", fmt::format("expected 1 channel or as many as the base, {}; found {}; put \"grayscale\" or "
                                   "\"channel_split\" before it",
                                   describe(base), describe(top)));
}

void require_one_space(const ImageFacts& base, const ImageFacts& top) {
  if (!base.color_space || !top.color_space) return;
  const std::string &base_space = *base.color_space, &top_space = *top.color_space;
  if (base_space != top_space && base_space != "raw" && top_space != "raw")
    throw Error("top",
                fmt::format("expected the base's colour space, {}, or raw; found {}; put \"convert_color\" before "
                            "one of them",
                            base_space, top_space));
}

/// The mode, unless it depends on the images.
void require_mode(const std::string& mode, const ImageFacts& base) {
  if (!base.semantic) return;
  if (is_normal_map(base) && mode != "auto" && mode != "detail" && mode != "normal")
    throw Error("mode", fmt::format("expected auto, normal or detail for normal maps, found {}", mode));
  if (!is_normal_map(base) && mode == "detail")
    throw Error("mode", fmt::format("detail is for normal maps, found {}; use one of {}", describe(base),
                                    fmt::join(mode_names, ", ")));
}

OutputForecasts infer_blend(const Params& params, const InputForecasts& inputs) {
  const ImageFacts base = image_at(inputs, "base"), top = image_at(inputs, "top"), mask = image_at(inputs, "mask");
  require_same_size("top", top, "base", base);
  require_same_size("mask", mask, "base", base);
  require_one_channel("mask", mask);
  require_alike(base, top);
  require_channels(base, top);
  require_one_space(base, top);
  require_mode(std::get<std::string>(params.at("mode")), base);
  return {{"image", forecast_of_image(base)}};
}

void compute_blend(NodeContext& node) {
  const BlendInputs in{node.input<Image>("base"), node.input<Image>("top"), node.optional_input<Image>("mask"),
                       node.number("opacity")};
  const std::string& mode = node.text("mode");
  if (in.base->info().semantic == Semantic::normal) {
    node.output("image", blend_normals(in, mode != "normal", node.key()));
    return;
  }
  const auto at = std::find(mode_names.begin(), mode_names.end(), mode == "auto" ? "normal" : mode);
  node.output("image", blend_values(in, BlendMode(at - mode_names.begin()), node.flag("linear"), node.key()));
}

}  // namespace

NodeType blend_node() {
  NodeType t;
  t.name = "blend";
  t.category = "image";
  t.summary = "Blends one image over another";
  t.help =
      "The usual modes of paint programs. Normal maps are laid over each other by reoriented normal mapping "
      "(Barre-Brisebois and Hill 2012), which keeps the strength of both, in the base's green convention; with mode "
      "normal the top replaces the base. The result has the base's semantic, colour space and bit depth; a fourth "
      "channel is blended like the others.";
  t.inputs = {image_port("base", "the bottom layer"),
              image_port("top", "the top layer: same size, 1 channel or as many as the base"),
              {.name = "mask",
               .type = ValueType::image,
               .help = "where the top shows: 1 channel, 1 = fully",
               .optional = true}};
  t.outputs = {image_port("image", "the blended image")};
  std::vector<std::string> modes = {"auto", "detail"};
  modes.insert(modes.end(), mode_names.begin(), mode_names.end());
  t.params = {
      {.name = "mode",
       .type = ParamType::choice,
       .fallback = "auto",
       .help = "auto: detail for normal maps, normal for everything else.",
       .choices = modes},
      {.name = "opacity",
       .type = ParamType::number,
       .fallback = 1.0,
       .help = "How much of the top shows; 0 leaves the base.",
       .min = 0,
       .max = 1},
      {.name = "linear",
       .type = ParamType::boolean,
       .fallback = true,
       .help = "Colours stored as srgb_texture are blended in linear light; false blends stored values, as most "
               "paint programs do."}};
  t.persist = Persist::derived;
  t.infer = infer_blend;
  t.compute = compute_blend;
  return t;
}

}  // namespace terrazzo
