#include <algorithm>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/image/image_facts.h"
#include "core/image/image_ops.h"
#include "core/image/normal.h"
#include "core/image/pixel_space.h"
#include "nodes/common/node_helpers.h"
#include "nodes/common/shape_rules.h"

namespace terrazzo {

namespace {

void compute_convert_normal(NodeContext& node) {
  const ImagePtr normal = node.input<Image>("normal");
  ImageInfo info = normal->info();
  const ImagePtr turned = with_normal_y(normal, normal_y_of(node));
  info.normal_y = normal_y_of(node);
  if (!node.flag("renormalize")) {
    node.output("normal", turned);
    return;
  }
  node.output("normal", pixel_by_pixel(info, node.key(), {turned}, [=](auto in, float* out, int64_t count) {
                std::copy_n(in[0], count * info.channels, out);
                to_stored(info, out, count);
              }));
}

OutputForecasts infer_convert_normal(const Params& params, const InputForecasts& inputs) {
  require_normals("normal", image_at(inputs, "normal"));
  return same_image_rule("normal", "normal")(params, inputs);
}

}  // namespace

NodeType convert_normal_node() {
  NodeType t;
  t.name = "convert_normal";
  t.category = "image";
  t.summary = "Converts a normal map between OpenGL and DirectX";
  t.help =
      "Reverses the green channel where the map has the other convention, and leaves a map alone that has this one "
      "already. Values of 8- and 16-bit maps come back exactly. If a map was loaded under the wrong convention, set "
      "\"normal_y\" where it is loaded instead; \"export\" converts by itself.";
  t.inputs = {image_port("normal", "the normal map, 3 channels or more")};
  t.outputs = {image_port("normal", "the same normals in that convention")};
  t.params = {normal_y_param(),
              {.name = "renormalize",
               .type = ParamType::boolean,
               .fallback = false,
               .help = "Makes every vector unit length as well, as \"normalize\" does."}};
  t.persist = Persist::digest;
  t.infer = infer_convert_normal;
  t.compute = compute_convert_normal;
  return t;
}

}  // namespace terrazzo
