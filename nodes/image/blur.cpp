#include "core/filter/resample.h"
#include "nodes/common/derived_edges.h"
#include "nodes/common/node_helpers.h"
#include "nodes/common/shape_rules.h"

namespace terrazzo {

namespace {

void compute_blur(NodeContext& node) {
  const ImagePtr image = node.input<Image>("image");
  const AxisFilter filter = gaussian_filter(node.number("radius"));
  const Outside outside = filter.copies ? Outside::clamp : derived_edges_of(node, image);
  const ImagePtr blurred = filtered(image, image->info(), node.key(), filter, filter, outside);
  if (!filter.copies) know_edges(blurred, outside);
  node.output("image", blurred);
}

}  // namespace

NodeType blur_node() {
  NodeType t;
  t.name = "blur";
  t.version = 5;
  t.category = "image";
  t.summary = "Gaussian blur";
  t.help =
      "Colours stored as srgb_texture are blurred in linear light, normals as vectors that are renormalised, "
      "everything else as stored. Pixels are computed on demand.";
  t.inputs = {image_port("image", "the image to blur")};
  t.outputs = {image_port("image", "the blurred image")};
  t.params = {
      {.name = "radius",
       .type = ParamType::number,
       .fallback = 2.0,
       .help = "Standard deviation (sigma) of the Gaussian, which reaches three times as far; more is smoother.",
       .min = 0,
       .max = 1000,
       .unit = "pixels"},
      derived_edges_param()};
  t.persist = Persist::digest;
  t.infer = same_image_rule();
  t.compute = compute_blur;
  return t;
}

}  // namespace terrazzo
