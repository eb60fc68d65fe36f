#include "nodes/common/exemplar_atlas.h"

#include <fmt/format.h>

#include "core/base/text.h"
#include "core/image/image_ops.h"
#include "nodes/common/node_helpers.h"
#include "nodes/common/shape_rules.h"

namespace terrazzo {

std::vector<Port> atlas_outputs() {
  return {material_port("material", "the exemplars side by side"),
          image_port("mask", "1 where an exemplar may be sampled, 0 in gaps: for \"weight\""),
          image_port("labels", "exemplar number, 0 for the first to 1 for the last: i / (count - 1)")};
}

std::vector<Param> atlas_params() {
  Param edges = edges_param();
  edges.help =
      "What fills gaps and the corners of rotated copies: clamp extends the border pixels, wrap repeats the exemplar "
      "(if it tiles; those corners can then be sampled too).";
  return {{.name = "gap",
           .type = ParamType::integer,
           .fallback = int64_t{8},
           .help = "Minimum distance between exemplars.",
           .min = 0,
           .max = 1024,
           .unit = "pixels"},
          edges};
}

void output_atlas(NodeContext& node, const std::vector<Exemplar>& exemplars, const std::string& how_to_shrink) {
  constexpr int64_t quick = int64_t{2048} * 2048;
  const Atlas atlas = make_atlas(exemplars, int(node.integer("gap")), edges_of(node));
  const Size size = atlas.material->size();
  std::string note = fmt::format("{} in {} pixels", counted(int64_t(exemplars.size()), "exemplar"), describe(size));
  if (size.area() > quick)
    note += fmt::format("; analysing so many takes long and needs much memory: use {}, or put \"resize\" before this",
                        how_to_shrink);
  node.note(note);
  node.output("material", atlas.material);
  node.output("mask", atlas.mask);
  node.output("labels", atlas.labels);
}

void require_mask_of(const InputForecasts& inputs, const std::string& port, size_t wire, const Forecast& material) {
  const ImageFacts mask = image_at(inputs, port, wire);
  require_one_channel(port, mask);
  require_shape(port, mask, "its material", material_size(material));
}

OutputForecasts atlas_forecast(const Forecast& first) {
  const auto without_size = [](const std::string&, ImageFacts& facts) { facts.size.reset(); };
  return {{"material", with_facts_changed(first, without_size)},
          {"mask", forecast_of_image(values_facts({}, Semantic::mask))},
          {"labels", forecast_of_image(values_facts({}, {}))}};
}

Exemplar masked_exemplar(const MaterialPtr& material, const ImagePtr& mask) {
  if (!mask) return {material, nullptr};
  ImageInfo info = mask->info();
  info.semantic = Semantic::mask;
  return {material, Image::redescribed(mask, info)};
}

}  // namespace terrazzo
