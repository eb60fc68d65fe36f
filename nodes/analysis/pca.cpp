#include <fmt/format.h>

#include "core/analysis/space/appearance_space.h"
#include "core/analysis/space/planes.h"
#include "core/base/text.h"
#include "core/node/node.h"
#include "nodes/common/shape_rules.h"
#include "nodes/common/synthesis/analysis_memory.h"

namespace terrazzo {

namespace {

void compute_pca(NodeContext& node) {
  AppearanceOptions options;
  options.dimensions = int(node.integer("dimensions"));
  options.retained_variance = node.number("retained_variance");
  options.guidance_weight = node.number("guidance_weight");
  const AppearancePtr appearance =
      make_appearance(*node.input<Features>("features"), node.list<Image>("guidance"), options, node.task());
  std::string text;
  for (const AppearanceLevel& l : appearance->levels())
    text += fmt::format("{}{}x{}: {} {} {:.1f} %", text.empty() ? "" : "; ", l.size.width, l.size.height,
                        counted(l.dimensions, "dimension"), l.dimensions == 1 ? "keeps" : "keep", 100 * l.retained);
  node.note(text);
  node.output("appearance", appearance);
}

OutputForecasts infer_pca(const Params&, const InputForecasts& inputs) {
  const Forecast& features = inputs.at("features").front();
  const std::optional<Size> size = features.size;
  if (size) require_analysable(*size);
  for (size_t i = 0; i < wires_at(inputs, "guidance"); i++) require_guidance(image_at(inputs, "guidance", i), size);
  return {{"appearance", {.size = size, .values = features.values}}};
}

}  // namespace

NodeType pca_node() {
  NodeType t;
  t.name = "pca";
  t.version = 3;
  t.category = "analysis";
  t.summary = "Transforms features into appearance space";
  t.help =
      "Per level of a Gaussian pyramid, every pixel's 5x5 neighbourhood in all weighted channels is reduced to a few "
      "principal components (appearance space; Lefebvre & Hoppe 2006). Comparing two pixels then compares their "
      "neighbourhoods.";
  t.inputs = {{.name = "features", .type = ValueType::features, .help = "the exemplar's weighted channels"},
              {.name = "guidance",
               .type = ValueType::image,
               .help = "images of the exemplar's size that steer coarse levels, such as the distance of \"guidance\"",
               .optional = true,
               .list = true}};
  t.outputs = {{.name = "appearance", .type = ValueType::appearance, .help = "the exemplar in appearance space"}};
  t.params = {
      {.name = "dimensions",
       .type = ParamType::integer,
       .fallback = appearance_dimensions,
       .help = "Maximum number of principal components. Fewer is less accurate.",
       .min = 1,
       .max = appearance_dimensions},
      {.name = "retained_variance",
       .type = ParamType::number,
       .fallback = 1.0,
       .help = "Keeps only as many components as explain this share of the variance; 1 keeps all.",
       .min = 0.01,
       .max = 1},
      {.name = "guidance_weight",
       .type = ParamType::number,
       .fallback = 0.25,
       .help = "Weight of the guidance at the coarsest level; it fades to 0 at the finest. Higher follows the guidance "
               "more than the maps.",
       .min = 0,
       .max = 100},
  };
  t.infer = infer_pca;
  t.compute = compute_pca;
  set_analysis_memory(t, "features", {.per_pixel = 48, .per_value = 6});
  return t;
}

}  // namespace terrazzo
