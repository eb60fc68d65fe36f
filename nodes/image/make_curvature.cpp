#include <algorithm>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/filter/curvature.h"
#include "core/filter/resample.h"
#include "core/image/image_facts.h"
#include "core/image/image_ops.h"
#include "core/image/pixel_space.h"
#include "nodes/common/derived_edges.h"
#include "nodes/common/node_helpers.h"
#include "nodes/common/shape_rules.h"

namespace terrazzo {

namespace {

/// The digest of an intermediate image.
Digest recipe_of(const NodeContext& node, const char* step) {
  return Hasher().add(node.key().hex()).add(step).digest();
}

ImageInfo on_the_way(Size size, int channels) {
  return {.size = size, .channels = channels};
}

/// An image whose pixels depend on others up to curvature_reach away.
template <typename Function>
ImagePtr from_neighbours(const NodeContext& node, const char* step, const ImagePtr& source, int channels,
                         Outside outside, const Function& function) {
  Operation operation{.sources = {source}, .compute = {}, .work = 10};
  operation.reads = [size = source->size(), outside](size_t, const Rect& region) {
    return padded_parts(size, grown(region, curvature_reach), outside);
  };
  operation.compute = [function](auto in, const Rect& region, float* out) { function(in[0], region, out); };
  return Image::computed(on_the_way(source->size(), channels), recipe_of(node, step), std::move(operation));
}

ImagePtr leanings_of(const NodeContext& node, const ImagePtr& image, Outside outside) {
  const ImageInfo& from = image->info();
  if (from.semantic == Semantic::normal && from.channels >= 3)
    return pixel_by_pixel(on_the_way(from.size, 2), recipe_of(node, "leanings"), {image},
                          [=, channels = from.channels, normal_y = from.normal_y](auto in, float* out, int64_t count) {
                            leanings_from_normals(in[0], channels, normal_y, count, out);
                          });
  return from_neighbours(
      node, "leanings", image, 2, outside,
      [scale = node.number("height_scale"), outside](const PixelView& in, const Rect& region, float* out) {
        leanings_from_height(in, region, scale, outside, out);
      });
}

void compute_make_curvature(NodeContext& node) {
  const ImagePtr image = node.input<Image>("image");
  const Outside outside = derived_edges_of(node, image);
  const ImagePtr curvature = from_neighbours(node, "curvature", leanings_of(node, image, outside), 1, outside,
                                             [outside](const PixelView& in, const Rect& region, float* out) {
                                               curvature_from_leanings(in, region, outside, out);
                                             });
  const double radius = node.number("radius");
  const AxisFilter blur = gaussian_filter(radius);
  const ImagePtr smooth =
      filtered(curvature, curvature->info(), recipe_of(node, "smooth curvature"), blur, blur, outside);

  ImageInfo info = image->info();
  info.channels = 1;
  info.semantic = Semantic::data;
  info.color_space = "raw";
  info.normal_y = NormalY::up;
  const std::string& shape = node.text("shape");
  const double strength = node.number("strength") * radius;
  const float flat = shape == "both" ? 0.5f : 0.0f;
  const float factor = float(shape == "both" ? strength : shape == "convex" ? 2 * strength : -2 * strength);
  node.output("curvature", pixel_by_pixel(info, node.key(), {smooth}, [=](auto in, float* out, int64_t count) {
                for (int64_t i = 0; i < count; i++) out[i] = std::clamp(flat + factor * in[0][i], 0.0f, 1.0f);
              }));
}

OutputForecasts infer_make_curvature(const Params&, const InputForecasts& inputs) {
  const ImageFacts image = image_at(inputs, "image");
  const bool may_be_height = image.semantic != Semantic::normal && image.channels.value_or(1) == 1;
  const bool may_be_normals =
      image.semantic.value_or(Semantic::normal) == Semantic::normal && image.channels.value_or(3) >= 3;
  if (!may_be_height && !may_be_normals)
    throw Error("image", fmt::format("expected a height map of 1 channel or a normal map of 3 channels, found {}",
                                     describe(image)));
  return {{"curvature", forecast_of_image({image.size, 1, Semantic::data, "raw"})}};
}

}  // namespace

NodeType make_curvature_node() {
  NodeType t;
  t.name = "make_curvature";
  t.version = 4;
  t.category = "image";
  t.summary = "Makes a curvature map from a height map or a normal map";
  t.help =
      "The mean curvature of the surface: light on ridges and edges, dark in grooves, 0.5 where it is flat or a "
      "saddle. Good for masks of wear and dirt. Measured as half of the divergence of the normals, averaged by a "
      "Gaussian of \"radius\" and multiplied by it, so that features of every scale come out alike (Lindeberg 1998): "
      "with strength 1, a dome whose radius is n times \"radius\" is 0.5 + 1 / n, a ridge like a cylinder half of that "
      "above 0.5. Pixels are computed on demand.";
  t.inputs = {image_port("image", "a height map, 1 channel; or a normal map")};
  t.outputs = {image_port("curvature", "values in 0..1, 1 channel, in the image's bit depth")};
  Param height_scale = height_scale_param();
  height_scale.help += " Normal maps have their own scale.";
  t.params = {height_scale,
              {.name = "radius",
               .type = ParamType::number,
               .fallback = 2.0,
               .help = "The scale of what shows: standard deviation of the Gaussian. More shows broad shapes in place "
                       "of fine ones.",
               .min = 0.5,
               .max = 500,
               .unit = "pixels"},
              {.name = "strength",
               .type = ParamType::number,
               .fallback = 1.0,
               .help = "Contrast: factor on the curvature.",
               .min = 0,
               .max = 100},
              {.name = "shape",
               .type = ParamType::choice,
               .fallback = "both",
               .help = "both: around 0.5. convex: ridges and edges only, and concave: grooves only; 0 elsewhere, with "
                       "twice the contrast.",
               .choices = {"both", "convex", "concave"}},
              derived_edges_param()};
  t.persist = Persist::derived;
  t.infer = infer_make_curvature;
  t.compute = compute_make_curvature;
  return t;
}

}  // namespace terrazzo
