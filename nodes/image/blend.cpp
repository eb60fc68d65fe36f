#include <algorithm>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/image/composite.h"
#include "core/image/image_ops.h"
#include "core/image/pixel_space.h"
#include "nodes/common/node_helpers.h"

namespace terrazzo {

namespace {

/// In the order of BlendMode.
const std::vector<std::string> mode_names = {"normal",   "multiply",   "screen", "overlay", "add",
                                             "subtract", "difference", "min",    "max"};

bool is_normal_map(const Image& image) {
  return image.info().semantic == Semantic::normal;
}

void check_inputs(const BlendInputs& in) {
  require_same_size("top", *in.top, "base", *in.base);
  if (in.mask) {
    require_same_size("mask", *in.mask, "base", *in.base);
    require_one_channel("mask", *in.mask);
  }
  if (is_normal_map(*in.base) != is_normal_map(*in.top))
    throw Error("top", fmt::format("expected normals over normals or values over values, found {} over {}",
                                   describe(*in.top), describe(*in.base)));
  if (is_normal_map(*in.base) && std::min(in.base->channels(), in.top->channels()) < 3)
    throw Error("top",
                fmt::format("expected normals of 3 channels, found {} over {}", describe(*in.top), describe(*in.base)));
  if (!is_normal_map(*in.base) && in.top->channels() != 1 && in.top->channels() != in.base->channels())
    throw Error("top", fmt::format("expected 1 channel or as many as the base, {}; found {}", describe(*in.base),
                                   describe(*in.top)));
  const std::string &base_space = in.base->info().color_space, &top_space = in.top->info().color_space;
  if (base_space != top_space && base_space != "raw" && top_space != "raw")
    throw Error("top",
                fmt::format("expected the base's colour space, {}, or raw; found {}; put \"convert_color\" before "
                            "one of them",
                            base_space, top_space));
}

void compute(NodeContext& node) {
  const BlendInputs in{node.input<Image>("base"), node.input<Image>("top"), node.optional_input<Image>("mask"),
                       node.number("opacity")};
  check_inputs(in);
  std::string mode = node.text("mode");
  if (mode == "auto") mode = is_normal_map(*in.base) ? "detail" : "normal";
  const auto at = std::find(mode_names.begin(), mode_names.end(), mode);
  if (is_normal_map(*in.base)) {
    if (mode != "detail" && mode != "normal")
      throw Error("mode", fmt::format("expected auto, normal or detail for normal maps, found {}", mode));
    node.output("image", blend_normals(in, mode == "detail", node.key()));
    return;
  }
  if (at == mode_names.end())
    throw Error("mode", fmt::format("detail is for normal maps, found {}; use one of {}", describe(*in.base),
                                    fmt::join(mode_names, ", ")));
  node.output("image", blend_values(in, BlendMode(at - mode_names.begin()), node.flag("linear"), node.key()));
}

Forecast preflight(const Params&, const InputForecasts& inputs) {
  const auto size_of = [&](const char* port) {
    const auto wires = inputs.find(port);
    const auto* sizes = wires == inputs.end() ? nullptr : &wires->second.front().sizes;
    return sizes && sizes->contains("") ? std::optional(sizes->at("")) : std::nullopt;
  };
  const std::optional<Size> base = size_of("base");
  for (const char* port : {"top", "mask"})
    if (const auto size = size_of(port); size && base && *size != *base)
      throw Error(port, fmt::format("expected the size of base, {}, found {}; resize brings one to the other",
                                    describe(*base), describe(*size)));
  Forecast out = inputs.at("base").front();
  if (!base) out.sizes.clear();
  return out;
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
  t.preflight = preflight;
  t.compute = compute;
  return t;
}

}  // namespace terrazzo
