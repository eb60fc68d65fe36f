#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/analysis/space/likeness.h"
#include "core/node/node.h"
#include "core/resolve/joined_heights.h"
#include "core/resolve/resolve.h"
#include "nodes/common/node_helpers.h"
#include "nodes/common/shape_rules.h"

namespace terrazzo {

namespace {

std::vector<Port> resolve_uv_inputs() {
  return {{.name = "uv", .type = ValueType::uv_map, .help = "which exemplar pixel each output pixel shows"},
          {.name = "material", .type = ValueType::material, .help = "the exemplar, with all maps wanted"},
          {.name = "kept",
           .type = ValueType::material,
           .help = "the earlier result whose pixels the uv map keeps: `join` and `tones` do not change them",
           .optional = true},
          {.name = "holes",
           .type = ValueType::image,
           .help = "a mask, stretched over the result: where it is white, `kept` is ignored",
           .optional = true}};
}

std::vector<Param> resolve_uv_params() {
  return {{.name = "blend",
           .type = ParamType::number,
           .fallback = 0.0,
           .help = "How far from a seam pixels are blended; more is softer. 2 to 3 hides most seams; 0 keeps every "
                   "pixel exact.",
           .min = 0,
           .max = largest_blend,
           .unit = "pixels of the uv map"},
          {.name = "join",
           .type = ParamType::number,
           .fallback = 0.0,
           .help = "How far from a seam one-channel height maps change so that pieces meet: below 1 a share of the "
                   "analysed exemplar's shorter side, else pixels of the uv map. More is smoother; 0 keeps heights "
                   "exact. Replaces `blend` for these maps.",
           .min = 0,
           .max = farthest_join},
          {.name = "tones",
           .type = ParamType::number,
           .fallback = 0.0,
           .help = "How far from a seam slow changes of tone meet, in maps whose tones are slow, such as stained or "
                   "polished metal: below 1 a share of the exemplar's shorter side, else pixels of the uv map. What "
                   "changes over a shorter distance stays, and so do all pixels of other maps. 0 keeps all exact.",
           .min = 0,
           .max = farthest_join},
          {.name = "kept_at",
           .type = ParamType::numbers,
           .fallback = Numbers{0, 0},
           .help = "Position of the top left pixel of `kept` in the result: [x, y].",
           .min = 0,
           .max = 32768,
           .unit = "pixels of the uv map",
           .max_count = 2},
          {.name = "scale",
           .type = ParamType::number,
           .fallback = 1.0,
           .help = "How many times larger the material is than the analysed exemplar, and the result than the uv map. "
                   "0 takes it from the material.",
           .min = 0,
           .max = largest_scale},
          {.name = "other_material",
           .type = ParamType::boolean,
           .fallback = false,
           .help = "Also takes a material that does not look like the analysed one. By default that is an error."}};
}

std::vector<std::string> check_resolve_uv(const Params& params) {
  const double scale = std::get<double>(params.at("scale"));
  std::vector<std::string> problems;
  if (scale > 0 && scale < 1)
    problems.push_back(
        fmt::format("\"scale\": expected 1 or more, or 0 to take it from the material's size; found {}", scale));
  const auto& at = std::get<Numbers>(params.at("kept_at"));
  if (at.size() != 2 || at[0] != std::floor(at[0]) || at[1] != std::floor(at[1]))
    problems.push_back("\"kept_at\": expected [x, y] in whole pixels");
  return problems;
}

/// The number of values held for all maps of the material, and per pixel of the result and of kept maps.
struct Held {
  double values = 0, per_result_pixel = 0, per_kept_pixel = 0;

  void add(const ImageInfo& map, const Params& params) {
    const bool joins = std::get<double>(params.at("join")) > 0 && can_join(map);
    const bool blends = std::get<double>(params.at("blend")) > 0 && !joins && can_blend(map.semantic);
    // Blending also needs linear pixels and their local means.
    values += double(map.size.area()) * map.channels * (blends ? 3 : 1);
    // The solution and its forces at half the result's size and at all coarser levels.
    if (joins) per_result_pixel += 2.0 / 3;
    if (joins || (std::get<double>(params.at("tones")) > 0 && SlowTones::exist_in(map))) per_kept_pixel += map.channels;
  }
  double bytes(Size result) const { return sizeof(float) * (values + per_result_pixel * double(result.area())); }
};

size_t memory_of_resolve_uv(const NodeContext& node) {
  const auto material = node.input<Material>("material");
  const auto uv = node.input<UvMap>("uv");
  const auto kept = node.optional_input<Material>("kept");
  const Size result = resolved_size(uv->size(), uv->exemplar(), material->size());
  Held held;
  for (const Map& m : material->maps()) held.add(m.image->info(), node.params());
  // A kept pixel's values, and whether it is free.
  const double of_kept =
      kept ? sizeof(float) * held.per_kept_pixel * double(kept->size().area()) + double(result.area()) : 0;
  return size_t(held.bytes(result) + of_kept);
}

uint64_t memory_ahead_of_resolve_uv(const Params& params, const InputForecasts& inputs) {
  const Forecast &material = inputs.at("material").front(), &uv = inputs.at("uv").front();
  const std::optional<Size> size = material_size(material);
  if (!size) return 0;
  Held held;
  for (const std::string& name : material.maps) {
    const ImageFacts map = map_of(material, name);
    held.add({.size = map.size.value_or(Size{}),
              .channels = map.channels.value_or(1),
              .semantic = map.semantic.value_or(Semantic::data)},
             params);
  }
  // The result of "make_tileable" may have any size near the exemplar's; only the maps are certain to be held.
  if (!uv.size || !uv.exemplar) return uint64_t(held.bytes({}));
  return uint64_t(held.bytes(resolved_size(*uv.size, *uv.exemplar, *size))) +
         uint64_t(uv.size->area()) * sizeof(ExemplarPixel);
}

/// Throws Error about "material" if it is certainly not the analysed one.
void require_analysed(const Material& material, const UvMap& uv, const Task& task) {
  if (!uv.fingerprint()) return;
  const std::optional<Likeness> found = likeness(*uv.fingerprint(), material, task);
  if (!found || found->correlation >= least_likeness()) return;
  throw Error("material",
              fmt::format("this is not the exemplar that was analysed: its {} and the analysed one's show other things "
                          "(correlation {:.2f}, expected {} or more); connect the maps that were analysed, in any "
                          "size, or analyse these; to use them anyway set \"other_material\" to true",
                          fmt::join(found->maps, ", "), found->correlation, least_likeness()));
}

void compute_resolve_uv(NodeContext& node) {
  const Numbers& at = node.numbers("kept_at");
  const auto material = node.input<Material>("material");
  const auto uv = node.input<UvMap>("uv");
  const ResolveOptions options{.blend = node.number("blend"),
                               .join = node.number("join"),
                               .tones = slow_tones(*material, *uv, node.number("tones"), node.task()),
                               .scale = node.number("scale"),
                               .kept = node.optional_input<Material>("kept"),
                               .kept_at = {int(at[0]), int(at[1])},
                               .holes = node.optional_input<Image>("holes")};
  MaterialPtr result = resolved(*material, uv, options, node.task());
  if (!node.flag("other_material")) require_analysed(*material, *uv, node.task());
  node.output("material", std::move(result));
  for (const auto& [name, tones] : options.tones)
    node.note(
        fmt::format("{}: its tones change slowly ({:.2f} of 1) and meet at seams; `tones` 0 keeps every pixel exact",
                    name, tones->slow_share()));
}

OutputForecasts infer_resolve_uv(const Params& params, const InputForecasts& inputs) {
  const Forecast &material = inputs.at("material").front(), &uv = inputs.at("uv").front();
  preflight_one_shape("material", inputs);
  const std::optional<Size> exemplar = material_size(material);
  if (exemplar && uv.exemplar) require_scale(*exemplar, *uv.exemplar, std::get<double>(params.at("scale")));
  std::optional<Size> size;
  if (exemplar && uv.exemplar && uv.size) size = resolved_size(*uv.size, *uv.exemplar, *exemplar);
  return {
      {"material", with_facts_changed(material, [&](const std::string&, ImageFacts& facts) { facts.size = size; })}};
}

}  // namespace

NodeType resolve_uv_node() {
  NodeType t;
  t.name = "resolve_uv";
  t.version = 2;
  t.category = "synthesis";
  t.summary = "Turns a uv map into the maps of a material";
  t.help =
      "Every output pixel of every map is exactly the exemplar pixel that the uv map names, unless `blend`, `join` "
      "or `tones` are set, so maps cannot drift apart. Pixels are computed on demand; only the exemplar is held in "
      "memory. "
      "`blend` softens seams: near a seam a pixel is the mean of what the pieces around it would continue with "
      "(Lefebvre & Hoppe 2005), colours in linear light, normals as vectors that keep their length, and details keep "
      "their contrast (Heitz & Neyret 2018). Away from seams pixels stay exact, and so do masks and data everywhere, "
      "since their values may be labels. `join` raises and lowers pieces of height maps so that they meet without "
      "steps: slopes, and cliffs that the exemplar has itself, stay, and the difference is spread over the "
      "surroundings (gradient-domain compositing, Perez, Gangnet & Blake 2003, with the screened Poisson equation of "
      "Bhat et al. 2008). Heights stay within the exemplar's range, and normals still fit. Tiles of a larger surface "
      "that are resolved one by one fit together only without `join`, which needs the whole result, and without "
      "`tones`, "
      "which looks beyond a tile's border. `tones` lets stains, clouds and vignettes of other maps meet at seams as "
      "slowly as they change in the exemplar, without touching what is finer (the lowest band of a multiresolution "
      "spline, Burt & Adelson 1983); maps whose tones change no slower than their texture stay exact. `scale` shows a "
      "larger exemplar than the analysed one: analyse and synthesize a copy reduced by `resize`, which is faster and "
      "captures larger features, and connect the original here. A material that is not the analysed one is an error: "
      "small copies of the analysed maps go with the uv map, and maps of the same names are compared with them.";
  t.inputs = resolve_uv_inputs();
  t.outputs = {
      {.name = "material", .type = ValueType::material, .help = "the maps, in the uv map's size times `scale`"}};
  t.params = resolve_uv_params();
  t.persist = Persist::derived;
  t.check = check_resolve_uv;
  t.memory_hint = memory_of_resolve_uv;
  t.memory_ahead = memory_ahead_of_resolve_uv;
  t.compute = compute_resolve_uv;
  t.infer = infer_resolve_uv;
  return t;
}

}  // namespace terrazzo
