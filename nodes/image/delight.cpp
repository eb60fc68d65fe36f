#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include "core/base/portable_math.h"
#include "core/filter/relief_light.h"
#include "core/filter/resample.h"
#include "core/filter/slow_light.h"
#include "core/image/image_facts.h"
#include "core/image/image_ops.h"
#include "core/image/normal.h"
#include "core/image/pixel_space.h"
#include "core/material/map_names.h"
#include "nodes/common/derived_edges.h"
#include "nodes/common/node_helpers.h"
#include "nodes/common/shape_rules.h"

namespace terrazzo {

namespace {

const std::string lit_name = "base_color";

/// Encoded normals with y up, of the colour's size; null if the material has neither normals nor heights.
ImagePtr relief_of(const Material& material, Size size, Outside outside) {
  ImagePtr normals = material.find("normal");
  if (normals && normals->channels() >= 3)
    normals = with_normal_y(normals, NormalY::up);
  else if (const ImagePtr height = material.find("height"))
    normals = normals_of_usual_slope(height, outside);
  else
    return nullptr;
  const Digest recipe = Hasher().add("relief of delight").add(normals->digest()).digest();
  return resampled(normals, size, "auto", outside, recipe);
}

/// How much of each light is taken out, 0..1.
struct Strengths {
  double slow, relief;
};

/// The colour divided by the light; `normals` may be null.
ImagePtr without_light(const NodeContext& node, const ImagePtr& color, const ImagePtr& normals, const SlowLight& slow,
                       const ReliefLight& relief, const Strengths& strengths) {
  const ImageInfo info = color->info();
  Hasher recipe;
  recipe.add(map_recipe(node, *color));
  Operation operation{.sources = {color}, .compute = {}, .work = 30};
  if (normals) {
    operation.sources.push_back(normals);
    recipe.add(normals->digest());
  }
  const int normal_channels = normals ? normals->channels() : 0;
  operation.compute = [=](std::span<const PixelView> in, const Rect& region, float* out) {
    in[0].read(region, out);
    to_linear(info, out, region.area());
    const std::vector<float> slopes = normal_channels ? in[1].read(region) : std::vector<float>();
    std::vector<double> logarithms(size_t(region.width));
    const int values = value_channels(info);
    float* pixel = out;
    const float* slope = slopes.data();
    for (int y = region.y; y < region.bottom(); y++) {
      slow.logarithms(region.x, y, region.width, logarithms.data());
      for (const double logarithm : logarithms) {
        double light = strengths.slow * logarithm;
        if (normal_channels) {
          const Vector3f n = normalized(decode_normal(slope, NormalY::up));
          const double shading = portable::log(relief.shading(double(n.x()), double(n.y())));
          light += strengths.relief * (shading - relief.mean_logarithm);
          slope += normal_channels;
        }
        const auto factor = float(portable::exp(-light));
        for (int c = 0; c < values; c++) pixel[c] *= factor;
        pixel += info.channels;
      }
    }
    to_stored(info, out, region.area());
  };
  return Image::computed(info, recipe.digest(), std::move(operation));
}

MaterialPtr with_colour(const Material& material, const ImagePtr& color) {
  std::vector<Map> maps;
  for (const Map& m : material.maps()) maps.push_back({m.name, m.name == lit_name ? color : m.image});
  return Material::make(material.name(), std::move(maps));
}

void note_found(NodeContext& node, const SlowLight& slow, const ReliefLight& relief, const Strengths& strengths) {
  if (slow.is_any())
    node.note(
        fmt::format("slow light: the brightest place had {:.0f} % more than the darkest", 100 * (slow.contrast() - 1)));
  else if (strengths.slow > 0)
    node.note("no slow light that differs from the tones of the surface");
  if (relief.is_any())
    node.note(fmt::format("light on the relief: from {:.0f} degrees; it explains {:.0f} % of the variance of tones",
                          relief.azimuth(), 100 * relief.explained));
}

void compute_delight(NodeContext& node) {
  const auto material = node.input<Material>("material");
  const ImagePtr color = material->find(lit_name);
  const Strengths strengths{node.number("strength"), node.number("relief")};
  const Outside outside = derived_edges_of(node, color);
  ImagePtr opacity = material->find("opacity");
  if (opacity) opacity = nearest_at_size(opacity, color->size());
  SlowLight slow;
  if (strengths.slow > 0) slow = SlowLight(color, opacity, int(node.integer("detail")), outside == Outside::wrap);
  ImagePtr normals = strengths.relief > 0 ? relief_of(*material, color->size(), outside) : nullptr;
  ReliefLight relief;
  if (normals) relief = relief_light(color, opacity, normals, slow, node.task());
  if (!relief.is_any()) normals = nullptr;
  note_found(node, slow, relief, strengths);
  if (!slow.is_any() && !normals) return node.output("material", material);
  const ImagePtr even = without_light(node, color, normals, slow, relief, strengths);
  know_edges(even, outside);
  node.output("material", with_colour(*material, even));
}

OutputForecasts infer_delight(const Params&, const InputForecasts& inputs) {
  const Forecast& input = inputs.at("material").front();
  if (input.possible_maps) {
    std::vector<std::string> known = input.maps;
    known.insert(known.end(), input.possible_maps->begin(), input.possible_maps->end());
    require_maps("material", {lit_name}, known);
  }
  return {{"material", input}};
}

}  // namespace

NodeType delight_node() {
  NodeType t;
  t.name = "delight";
  t.category = "image";
  t.version = 3;
  t.summary = "Takes the light out of a base colour that was photographed in the sun";
  t.help =
      "Slow light: a side that is brighter than the other, a vignette, a pool of light (homomorphic filtering; "
      "Oppenheim, Schafer & Stockham 1968). It must clearly exceed what the surface varies by itself, and its colours "
      "must not change with it; otherwise it stays, so that stones of unlike colours keep theirs. Light on the relief: "
      "with a normal or height map, the direction of the light is found that makes slopes towards it brighter, and "
      "that shading is divided out, if the light is the same all over the picture. Works in linear light, and keeps "
      "the mean brightness. Only base_color changes. Cast shadows and reflections stay: photograph in flat light where "
      "you can.";
  t.inputs = {material_port("material", "the material, with base_color; a normal or height map helps")};
  t.outputs = {material_port("material", "the same with an evenly lit base_color")};
  t.params = {{.name = "strength",
               .type = ParamType::number,
               .fallback = 1.0,
               .help = "How much of the slow light is taken out; 0 leaves it.",
               .min = 0,
               .max = 1},
              {.name = "relief",
               .type = ParamType::number,
               .fallback = 1.0,
               .help = "How much of the shading of the relief is taken out; 0 leaves it.",
               .min = 0,
               .max = 1},
              {.name = "detail",
               .type = ParamType::integer,
               .fallback = int64_t{2},
               .help = "How quickly slow light may change: 1 is a slope, 2 also a vignette, 3 and 4 also patches of a "
                       "third of the picture, and more of the surface's own tones.",
               .min = 1,
               .max = SlowLight::most_detail},
              derived_edges_param()};
  t.persist = Persist::digest;
  t.infer = infer_delight;
  t.compute = compute_delight;
  return t;
}

}  // namespace terrazzo
