#include "core/image_io/color.h"
#include "core/node/node.h"
#include "core/picture/picture_grid.h"

namespace terrazzo {

namespace {

GridSpec spec_of(const Params& params) {
  return {int(std::get<int64_t>(params.at("columns"))), std::get<Size>(params.at("cell")),
          int(std::get<int64_t>(params.at("gap"))), std::get<bool>(params.at("enlarge")),
          std::get<Texts>(params.at("captions"))};
}

void compute_contact_sheet(NodeContext& node) {
  node.output("image", picture_grid(node.list<Image>("images"), spec_of(node.params()), node.task()));
}

}  // namespace

NodeType contact_sheet_node() {
  NodeType t;
  t.name = "contact_sheet";
  t.version = 3;
  t.category = "image";
  t.summary = "Lays pictures out in rows, with captions";
  t.help =
      "For comparing variants of one graph at a glance. Each picture is scaled down to fit its cell and centred. "
      "Colours are shown as sRGB, images of one or two channels as grey, without alpha. Values are clipped to 0..1: "
      "put \"normalize\" before images of other ranges. Materials go through \"preview\" first, which lights them.";
  t.inputs = {{.name = "images", .type = ValueType::image, .help = "the pictures, in reading order", .list = true}};
  t.outputs = {{.name = "image", .type = ValueType::image, .help = "8-bit colour picture"}};
  t.params = {
      {.name = "columns",
       .type = ParamType::integer,
       .fallback = int64_t{4},
       .help = "Pictures in a row, at most.",
       .min = 1,
       .max = 256},
      {.name = "cell",
       .type = ParamType::size,
       .fallback = Size{256, 256},
       .help = "Size of each cell.",
       .min = 8,
       .max = 8192,
       .unit = "pixels"},
      {.name = "gap",
       .type = ParamType::integer,
       .fallback = int64_t{8},
       .help = "Space around the cells.",
       .min = 0,
       .max = 256,
       .unit = "pixels"},
      {.name = "enlarge",
       .type = ParamType::boolean,
       .fallback = false,
       .help = "Scales up pictures smaller than their cell. false keeps their size, so that exemplar and "
               "result appear at one scale."},
      {.name = "captions",
       .type = ParamType::texts,
       .fallback = Texts{},
       .help = "Texts below the pictures, in their order, set in capitals, in up to three lines; \"\" for none."}};
  t.persist = Persist::payload;
  t.files_read = [](const Params&) { return color_config_files(); };
  t.memory_hint = [](const NodeContext& node) {
    const size_t pictures = node.list<Image>("images").size();
    return size_t(grid_size(pictures, spec_of(node.params())).area()) * 3 * sizeof(float);
  };
  t.compute = compute_contact_sheet;
  t.infer = [](const Params& params, const InputForecasts& inputs) {
    const size_t pictures = inputs.at("images").size();
    require_grid(pictures, spec_of(params));
    const ImageFacts sheet{
        .size = grid_size(pictures, spec_of(params)), .channels = 3, .semantic = Semantic::base_color};
    return OutputForecasts{{"image", {.images = {{"", sheet}}}}};
  };
  return t;
}

}  // namespace terrazzo
