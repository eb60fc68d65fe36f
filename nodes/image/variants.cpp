#include "core/material/variants.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "nodes/common/exemplar_atlas.h"
#include "nodes/common/node_helpers.h"

namespace terrazzo {

namespace {

constexpr size_t most_variants = 64;

double within_a_turn(double degrees) {
  const double rest = std::fmod(degrees, 360.0);
  return rest < 0 ? rest + 360 : rest;
}

/// The original first; no duplicates.
std::vector<Variant> asked_variants(const Params& params) {
  const std::string& mirror = std::get<std::string>(params.at("mirror"));
  std::vector<Variant> all;
  const auto add = [&](double scale, bool x, bool y, double rotation) {
    const Variant v{scale, x, y, within_a_turn(rotation)};
    if (std::find(all.begin(), all.end(), v) == all.end()) all.push_back(v);
  };
  Numbers rotations{0}, scales{1};
  for (const double r : std::get<Numbers>(params.at("rotations"))) rotations.push_back(r);
  for (const double s : std::get<Numbers>(params.at("scales"))) scales.push_back(s);
  for (const double scale : scales)
    for (const bool y : {false, true})
      for (const bool x : {false, true}) {
        if ((x && mirror.find('x') == mirror.npos) || (y && mirror.find('y') == mirror.npos)) continue;
        for (const double rotation : rotations) add(scale, x, y, rotation);
      }
  return all;
}

std::vector<std::string> check_variants(const Params& params) {
  const size_t count = asked_variants(params).size();
  if (count <= most_variants) return {};
  return {fmt::format("\"rotations\", \"scales\" and \"mirror\" together give {} copies; expected at most {}", count,
                      most_variants)};
}

std::vector<Exemplar> varied_exemplars(const Exemplar& original, const Params& params, Outside edges) {
  std::vector<Exemplar> exemplars;
  for (const Variant& v : asked_variants(params)) exemplars.push_back(varied(original, v, edges));
  return exemplars;
}

void compute_variants(NodeContext& node) {
  const Exemplar original = masked_exemplar(node.input<Material>("material"), node.optional_input<Image>("mask"));
  output_atlas(node, varied_exemplars(original, node.params(), edges_of(node)), "fewer `rotations` or `scales`");
}

OutputForecasts infer_variants(const Params& params, const InputForecasts& inputs) {
  const Forecast& material = inputs.at("material").front();
  require_mask_of(inputs, "mask", 0, material);
  return atlas_forecast({material}, int(std::get<int64_t>(params.at("gap"))),
                        [&](const std::vector<MaterialPtr>& original) {
                          return varied_exemplars({original.front(), nullptr}, params, Outside::clamp);
                        });
}

}  // namespace

NodeType variants_node() {
  NodeType t;
  t.name = "variants";
  t.version = 2;
  t.category = "image";
  t.summary = "Adds turned, mirrored and scaled copies of an exemplar";
  t.help =
      "A small exemplar gives more variety if it may also appear turned, mirrored or at other scales. The original and "
      "its copies, every rotation at every scale and mirroring, lie side by side in one material, as with \"combine\": "
      "connect the mask to \"weight\", set \"tiles\" to no there, and connect the labels to \"regularity\". Normals "
      "turn with the surface. Scaling is in all three dimensions: normals stay, and heights scale about their mean (8- "
      "and 16-bit maps clip to 0..1: leave headroom with \"levels\" for scales above 1). Multiples of 90 degrees only "
      "move pixels; other rotations interpolate (cubic convolution), and their empty corners are masked out. Do not "
      "turn materials that have an up and down, or baked-in light. With large features, mirrored copies can form "
      "butterfly patterns.";
  t.inputs = {material_port("material", "the exemplar"),
              {.name = "mask",
               .type = ValueType::image,
               .help = "where the exemplar may be sampled: white (above 0.5), 1 channel",
               .optional = true}};
  t.outputs = atlas_outputs();
  t.params = {
      {.name = "rotations",
       .type = ParamType::numbers,
       .fallback = Numbers{90, 180, 270},
       .help = "Angles of the copies, counter-clockwise; [] for none.",
       .min = -360,
       .max = 360,
       .unit = "degrees",
       .max_count = 16},
      {.name = "scales",
       .type = ParamType::numbers,
       .fallback = Numbers{},
       .help = "Scale factors of the copies; 2 is twice as large.",
       .min = 0.1,
       .max = 10,
       .max_count = 16},
      {.name = "mirror",
       .type = ParamType::choice,
       .fallback = "none",
       .help =
           "Adds copies with left and right swapped (x), top and bottom swapped (y), or all three combinations (xy).",
       .choices = {"none", "x", "y", "xy"}}};
  for (Param& p : atlas_params()) t.params.push_back(std::move(p));
  t.persist = Persist::derived;
  t.check = check_variants;
  t.compute = compute_variants;
  t.infer = infer_variants;
  return t;
}

}  // namespace terrazzo
