#include <algorithm>

#include <fmt/format.h>

#include "core/analysis/elements/find_elements.h"
#include "core/base/hash.h"
#include "core/node/node.h"
#include "nodes/common/node_helpers.h"
#include "nodes/common/shape_rules.h"
#include "nodes/common/synthesis/analysis_memory.h"

namespace terrazzo {

namespace {

ImagePtr label_image(const Elements& elements) {
  const ImageInfo info{.size = elements.size, .channels = 1, .semantic = Semantic::guidance, .depth = Depth::u16};
  const double steps = std::max(1, elements.count - 1);
  std::vector<float> labels(elements.at.size());
  std::ranges::transform(elements.at, labels.begin(), [steps](uint16_t e) { return float(e / steps); });
  return Image::from_floats(info, std::move(labels));
}

/// A colour for each element; neighbours rarely have similar ones.
ImagePtr coloured(const Elements& elements) {
  const ImageInfo info{
      .size = elements.size, .channels = 3, .semantic = Semantic::base_color, .color_space = "srgb_texture"};
  std::vector<float> pixels;
  pixels.reserve(elements.at.size() * 3);
  for (const uint16_t e : elements.at)
    for (uint64_t c = 0; c < 3; c++) pixels.push_back(0.2f + 0.7f * float(unit_double(random_bits(1, e, c))));
  return Image::from_floats(info, std::move(pixels));
}

Elements one_element(Size size) {
  return {size, std::vector<uint16_t>(size_t(size.area())), 1, 0};
}

void compute_elements(NodeContext& node) {
  const auto features = node.input<Features>("features");
  const double share = features->repeats().lattice.rank == 0 ? sure_without_lattice : 1;
  const double least = share * node.number("least_certainty");
  ElementsPtr elements = find_elements(*features, node.task());
  if (elements && elements->certainty < least) {
    node.note(fmt::format(
        "no elements: their joints do not stand out (certainty {:.2f}, below {:.3g}, which \"least_certainty\" "
        "asks for)",
        elements->certainty, least));
    elements = nullptr;
  } else if (!elements) {
    node.note("no elements found");
  } else {
    node.note(fmt::format("{} elements, {} of them whole, certainty {:.2f}", elements->count,
                          whole_elements(*elements, features->wraps()), elements->certainty));
  }
  node.output("features", features->with(elements));
  const Elements shown = elements ? *elements : one_element(features->size());
  node.output("labels", label_image(shown));
  node.output("picture", coloured(shown));
}

}  // namespace

NodeType elements_node() {
  NodeType t;
  t.name = "elements";
  t.version = 5;
  t.category = "analysis";
  t.summary = "Parts an exemplar into its elements: stones, bricks, slates, tiles";
  t.help =
      "Finds the joints, dark or light, in all weighted channels together, and floods the exemplar from within its "
      "elements up to them. Synthesis then lays elements as wholes: seams run in joints, and no stone is put together "
      "from several. Exemplars without elements, such as sand and grass, pass through unchanged.";
  t.inputs = {{.name = "features", .type = ValueType::features, .help = "the exemplar's weighted channels"}};
  t.outputs = {{.name = "features", .type = ValueType::features, .help = "the same, with their elements"},
               image_port("labels",
                          "number of the element that each pixel belongs to, 0 for the first to 1 for the last: "
                          "i / (elements - 1); 0 everywhere if there are none"),
               image_port("picture", "each element in a colour of its own, to look at")};
  t.params = {{.name = "least_certainty",
               .type = ParamType::number,
               .fallback = sure_elements,
               .help =
                   "Elements found with less certainty are not used. Higher accepts fewer; 0 takes what there is. Of "
                   "exemplars without a lattice three quarters of it will do, since nothing else keeps their stones "
                   "whole.",
               .min = 0,
               .max = 1}};
  t.persist = Persist::payload;
  set_analysis_memory(t, "features", lattice_memory);
  t.infer = [](const Params&, const InputForecasts& inputs) {
    const Forecast& features = inputs.at("features").front();
    return OutputForecasts{{"features", {.size = features.size, .values = features.values}},
                           {"labels", forecast_of_image(values_facts(features.size, Semantic::guidance))},
                           {"picture", forecast_of_image(values_facts(features.size, Semantic::base_color, 3))}};
  };
  t.compute = compute_elements;
  return t;
}

}  // namespace terrazzo
