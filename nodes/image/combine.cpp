#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/base/error.h"
#include "core/base/text.h"
#include "core/image/image_facts.h"
#include "core/image_io/color.h"
#include "core/material/map_names.h"
#include "core/material/mix.h"
#include "nodes/common/exemplar_atlas.h"
#include "nodes/common/node_helpers.h"
#include "nodes/common/shape_rules.h"

namespace terrazzo {

namespace {

void require_masks(size_t masks, size_t materials) {
  if (masks == 0 || masks == materials) return;
  throw Error("masks", fmt::format("expected {}, one for each material, or none; found {}",
                                   counted(int64_t(materials), "mask"), masks));
}

const std::vector<std::string> border_names = {"hard", "soft", "height"};  ///< in the order of Border

Border border_of(const Params& params) {
  const auto at = std::ranges::find(border_names, std::get<std::string>(params.at("border")));
  return Border(at - border_names.begin());
}

MixOptions mix_options(const Params& params) {
  const std::string& tileable = std::get<std::string>(params.at("tileable"));
  return {.border = border_of(params),
          .width = std::get<double>(params.at("width")),
          .softness = std::get<double>(params.at("softness")),
          .offset = std::get<double>(params.at("offset")),
          .wraps_x = tileable.find('x') != tileable.npos,
          .wraps_y = tileable.find('y') != tileable.npos};
}

ImagePtr constant_mask(Size size) {
  const ImageInfo info{.size = size, .channels = 1, .semantic = Semantic::mask, .depth = Depth::u8};
  const Digest recipe = Hasher().add("white").add(size.width).add(size.height).digest();
  return Image::computed(info, recipe, [](const Rect& region, float* out) { std::fill_n(out, region.area(), 1.0f); });
}

/// Notes for the user about a mix.
void tell_of(NodeContext& node, const Mix& mix, Size map) {
  std::vector<std::string> shares;
  for (const double part : mix.parts) shares.push_back(fmt::format("{:.0f} %", 100 * part));
  const Size size = mix.material->size();
  node.note(fmt::format("the materials cover {} of {} pixels", fmt::join(shares, ", "), describe(size)));
  if (const auto unseen = std::ranges::count(mix.parts, 0.0); unseen > 0)
    node.warn(
        fmt::format("\"mix\" shows only {} of the {} materials; expected values from 0, the first, to 1, the last",
                    int64_t(mix.parts.size()) - unseen, mix.parts.size()));
  if (map.area() > 1 && !same_shape(map, size))
    node.note(fmt::format("the mix map of {} pixels is stretched to the materials' {}, which has another aspect ratio",
                          describe(map), describe(size)));
}

void output_mix(NodeContext& node, const std::vector<MaterialPtr>& materials, const ImagePtr& map) {
  const Mix mix = mixed(materials, map, mix_options(node.params()));
  tell_of(node, mix, map->size());
  node.output("material", mix.material);
  node.output("mask", constant_mask(mix.material->size()));
  node.output("labels", mix.labels);
}

void compute_combine(NodeContext& node) {
  const auto materials = node.list<Material>("materials");
  if (const auto map = node.optional_input<Image>("mix")) {
    output_mix(node, materials, map);
    return;
  }
  const auto masks = node.list<Image>("masks");
  std::vector<Exemplar> exemplars;
  for (size_t i = 0; i < materials.size(); i++)
    exemplars.push_back(masked_exemplar(materials[i], masks.empty() ? nullptr : masks[i]));
  output_atlas(node, exemplars, "fewer materials");
}

/// The facts that are known for the maps of all materials.
std::vector<KnownMaps> known_maps(const InputForecasts& inputs) {
  std::vector<KnownMaps> materials;
  for (const Forecast& f : inputs.at("materials")) materials.push_back({"", f.maps, f.possible_maps});
  return materials;
}

void require_compared_heights(const std::vector<KnownMaps>& materials) {
  for (size_t i = 0; i < materials.size(); i++) {
    if (!materials[i].possible_maps) continue;
    std::vector<std::string> all = materials[i].maps;
    all.insert(all.end(), materials[i].possible_maps->begin(), materials[i].possible_maps->end());
    require_height_to_compare(all, fmt::format("material {}", i + 1));
  }
}

/// The common size of all materials; nullopt if one is unknown. Throws Error if they are known to differ.
std::optional<Size> size_of_all(const std::vector<Forecast>& materials) {
  std::vector<Size> known;
  for (const Forecast& m : materials)
    if (const std::optional<Size> size = material_size(m)) known.push_back(*size);
  for (const Size& size : known) require_one_size(known.front(), size);
  return known.size() == materials.size() ? std::optional(known.front()) : std::nullopt;
}

OutputForecasts mix_forecast(const Params& params, const InputForecasts& inputs) {
  const std::vector<Forecast>& materials = inputs.at("materials");
  std::optional<Size> size;
  check_all(
      [&] { require_one_channel("mix", image_at(inputs, "mix")); },
      [&] {
        if (wires_at(inputs, "masks") > 0)
          throw Error(
              "masks",
              "are for exemplars side by side; with \"mix\", which lays materials over each other, leave them open");
      },
      [&] {
        if (border_of(params) == Border::height) require_compared_heights(known_maps(inputs));
      },
      [&] { size = size_of_all(materials); });
  const auto unless_they_differ = [&](const std::string& map, ImageFacts& facts) {
    for (const Forecast& m : materials)
      if (map_of(m, map).size != facts.size) facts.size.reset();
  };
  return {{"material", with_facts_changed(materials.front(), unless_they_differ)},
          {"mask", forecast_of_image(values_facts(size, Semantic::mask))},
          {"labels", forecast_of_image(values_facts(size, Semantic::guidance))}};
}

OutputForecasts infer_combine(const Params& params, const InputForecasts& inputs) {
  const std::vector<KnownMaps> materials = known_maps(inputs);
  const bool lays_over = wires_at(inputs, "mix") > 0;
  check_all([&] { require_same_maps("materials", materials); },
            [&] {
              if (!lays_over) require_masks(wires_at(inputs, "masks"), materials.size());
            },
            [&] {
              if (!lays_over && border_of(params) != Border::hard)
                throw Error("border",
                            "is for materials laid over each other; connect \"mix\", which says where each shows");
            });
  if (lays_over) return mix_forecast(params, inputs);
  for (size_t i = 0; i < materials.size(); i++) require_mask_of(inputs, "masks", i, inputs.at("materials")[i]);
  return atlas_forecast(inputs.at("materials"), int(std::get<int64_t>(params.at("gap"))),
                        [](const std::vector<MaterialPtr>& all) {
                          std::vector<Exemplar> exemplars;
                          for (const MaterialPtr& m : all) exemplars.push_back({m, nullptr});
                          return exemplars;
                        });
}

std::vector<Param> combine_params() {
  std::vector<Param> all = atlas_params();
  all[0].help += " Side by side only.";
  all[1].help = "Side by side only: what fills gaps. clamp extends the border pixels, wrap repeats the exemplar.";
  all.push_back({.name = "border",
                 .type = ParamType::choice,
                 .fallback = "hard",
                 .help =
                     "How materials meet where \"mix\" lays them over each other. hard: every pixel shows one. soft: "
                     "one fades into the other. height: the higher one shows, so stones stand out of sand; needs "
                     "height maps.",
                 .choices = border_names});
  all.push_back({.name = "width",
                 .type = ParamType::number,
                 .fallback = 16.0,
                 .help = "Width of a soft border, or of the strip in which heights are compared, half of it on either "
                         "side; about a stone for stones to stay whole. Below 1 borders are hard.",
                 .min = 0,
                 .max = widest_border,
                 .unit = "pixels"});
  all.push_back({.name = "softness",
                 .type = ParamType::number,
                 .fallback = 0.1,
                 .help = "Borders by height: materials are mixed where their heights differ by less, as a share of the "
                         "range of heights. 0 cuts sharply.",
                 .min = 0,
                 .max = 1});
  all.push_back({.name = "offset",
                 .type = ParamType::number,
                 .fallback = 0.0,
                 .help =
                     "Borders by height: how much higher each material counts than the one before it, as a share of "
                     "the range of heights. Above 0 the later one covers more, below 0 less.",
                 .min = -1,
                 .max = 1});
  all.push_back({.name = "tileable",
                 .type = ParamType::choice,
                 .fallback = "none",
                 .help = "Directions in which materials and mix map wrap, so that borders go on across the edges.",
                 .choices = {"none", "x", "y", "xy"}});
  return all;
}

}  // namespace

NodeType combine_node() {
  NodeType t;
  t.name = "combine";
  t.category = "image";
  t.summary = "Lays several exemplars side by side as one, or materials over each other where a map says so";
  t.help =
      "For making one result from several exemplars of a surface, such as photographs of neighbouring spots, or a "
      "clean and a worn one. The material goes wherever an exemplar goes: weight, guidance, resolve_uv. Connect the "
      "mask to \"weight\", so that the gaps are never shown, and set \"tiles\" to no in all analysis nodes. Connect "
      "the labels to \"regularity\", so that each exemplar gets its own lattice and joints of bricks and tiles meet, "
      "or to \"transfer\", to steer which exemplar is used where. Exemplars must have the same maps; sizes may differ. "
      "Pixels do not change, except that colours and normals take the first exemplar's colour space and convention. "
      "With \"mix\" connected, materials of one size, such as results, are laid over each other instead: where it is "
      "black the first shows, where it is white the last. `border` says how they meet. By height, an intruder sinks "
      "the "
      "farther it is beyond its border (Mishkinis 2013, with distance in place of painted opacity); its height map "
      "sinks "
      "with it, so heights have no steps unless `offset` makes some. Colours are mixed in linear light, normals as "
      "unit "
      "vectors; masks, guidance and data show the material that shows most.";
  t.inputs = {{.name = "materials", .type = ValueType::material, .help = "the exemplars", .list = true},
              {.name = "masks",
               .type = ValueType::image,
               .help = "for each exemplar where it may be sampled: white (above 0.5), 1 channel",
               .optional = true,
               .list = true},
              {.name = "mix",
               .type = ValueType::image,
               .help = "where each material shows, stretched over them: 1 channel, 0 the first to 1 the last, as "
                       "`labels`; of two the second above 0.5",
               .optional = true}};
  t.outputs = atlas_outputs();
  t.outputs[0].help = "the exemplars side by side, or the mix";
  t.outputs[1].help += "; of a mix 1";
  t.outputs[2].help += "; of a mix the one that shows most";
  t.params = combine_params();
  t.persist = Persist::derived;
  t.files_read = [](const Params&) { return color_config_files(); };
  t.compute = compute_combine;
  t.infer = infer_combine;
  return t;
}

}  // namespace terrazzo
