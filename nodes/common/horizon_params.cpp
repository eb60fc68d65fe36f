#include "nodes/common/horizon_params.h"

namespace terrazzo {

Param horizon_radius_param() {
  return {
      .name = "radius",
      .type = ParamType::integer,
      .fallback = int64_t{32},
      .help =
          "How far away occluders count; their effect fades with distance. More darkens wider areas and takes longer.",
      .min = 1,
      .max = 512,
      .unit = "pixels"};
}

HorizonOptions horizon_options_of(NodeContext& node, const ImagePtr& height) {
  return {.height_scale = node.number("height_scale"),
          .radius = int(node.integer("radius")),
          .outside = derived_edges_of(node, height)};
}

Operation horizon_operation(const ImagePtr& height, const HorizonOptions& options) {
  Operation operation{.sources = {height}, .compute = {}, .work = 16.0 * options.radius};
  operation.reads = [options, size = height->size()](size_t, const Rect& region) {
    return padded_parts(size, grown(region, options.radius), options.outside);
  };
  return operation;
}

}  // namespace terrazzo
