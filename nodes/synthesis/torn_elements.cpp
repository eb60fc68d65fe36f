#include <algorithm>
#include <vector>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/metrics/whole_elements.h"
#include "nodes/common/node_helpers.h"
#include "nodes/common/shape_rules.h"
#include "nodes/common/synthesis/synthesis_params.h"

namespace terrazzo {

namespace {

void compute_torn_elements(NodeContext& node) {
  const auto uv = node.input<UvMap>("uv");
  const auto index = node.input<Index>("index");
  const Appearance& appearance = *index->appearance();
  if (uv->exemplar() != appearance.size())
    throw Error("uv",
                fmt::format("expected a uv map for the exemplar of \"index\", {}, found one for an exemplar of {}",
                            describe(appearance.size()), describe(uv->exemplar())));
  std::vector<float> mask(size_t(uv->size().area()), 0.0f);
  if (const ElementsPtr& elements = appearance.elements()) {
    const std::vector<uint8_t> torn = torn_elements(*uv, *elements, node.task());
    std::ranges::copy(torn, mask.begin());
    const int64_t count = std::ranges::count(torn, 1);
    node.note(fmt::format("{:.1f} % of the result is torn", 100.0 * double(count) / double(torn.size())));
  } else {
    node.warn("the analysis knows no elements, so none are torn: put the node `elements` before `pca`");
  }
  node.output("mask", Image::from_floats({.size = uv->size(), .semantic = Semantic::mask, .depth = Depth::u8},
                                         std::move(mask)));
}

OutputForecasts infer_torn_elements(const Params&, const InputForecasts& inputs) {
  require_same_exemplar(inputs);
  return {{"mask", forecast_of_image({inputs.at("uv").front().size, 1, Semantic::mask, "raw"})}};
}

}  // namespace

NodeType torn_elements_node() {
  NodeType t;
  t.name = "torn_elements";
  t.category = "synthesis";
  t.summary = "Marks elements of a result that are torn or melted together";
  t.help =
      "A mask of the stones, bricks or tiles of a result that are not one whole element of the exemplar: it is white "
      "inside of those, and black in whole ones, in joints and where the border of the result cuts. It shows what a "
      "warning of `synthesize` speaks of, and is a mask for `inpaint`. The analysis must know the elements (node "
      "`elements`).";
  t.inputs = {{.name = "uv", .type = ValueType::uv_map, .help = "the result"}, index_port()};
  t.outputs = {image_port("mask", "the mask, 1 channel, as large as the uv map")};
  t.infer = infer_torn_elements;
  t.compute = compute_torn_elements;
  t.memory_hint = [](const NodeContext& node) {
    return size_t(node.input<UvMap>("uv")->size().area()) * (sizeof(float) + sizeof(uint8_t));
  };
  return t;
}

}  // namespace terrazzo
