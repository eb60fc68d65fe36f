#include "nodes/common/exemplar_atlas.h"

#include <algorithm>
#include <optional>

#include <fmt/format.h>

#include "core/base/text.h"
#include "core/image/image_facts.h"
#include "nodes/common/node_helpers.h"
#include "nodes/common/shape_rules.h"

namespace terrazzo {

std::vector<Port> atlas_outputs() {
  return {material_port("material", "the exemplars side by side"),
          image_port("mask", "1 where an exemplar may be sampled, 0 in gaps: for \"weight\""),
          image_port("labels", "exemplar number, 0 for the first to 1 for the last: i / (count - 1)")};
}

std::vector<Param> atlas_params() {
  Param edges = edges_param();
  edges.help =
      "What fills gaps and the corners of rotated copies: clamp extends the border pixels, wrap repeats the exemplar "
      "(if it tiles; those corners can then be sampled too).";
  return {{.name = "gap",
           .type = ParamType::integer,
           .fallback = int64_t{8},
           .help = "Minimum distance between exemplars.",
           .min = 0,
           .max = 1024,
           .unit = "pixels"},
          edges};
}

void output_atlas(NodeContext& node, const std::vector<Exemplar>& exemplars, const std::string& how_to_shrink) {
  constexpr int64_t quick = int64_t{2048} * 2048;
  const Atlas atlas = make_atlas(exemplars, int(node.integer("gap")), edges_of(node));
  const Size size = atlas.material->size();
  std::string note = fmt::format("{} in {} pixels", counted(int64_t(exemplars.size()), "exemplar"), describe(size));
  if (size.area() > quick)
    note += fmt::format("; analysing so many takes long and needs much memory: use {}, or put \"resize\" before this",
                        how_to_shrink);
  node.note(note);
  node.output("material", atlas.material);
  node.output("mask", atlas.mask);
  node.output("labels", atlas.labels);
}

void require_mask_of(const InputForecasts& inputs, const std::string& port, size_t wire, const Forecast& material) {
  const ImageFacts mask = image_at(inputs, port, wire);
  require_one_channel(port, mask);
  require_shape(port, mask, "its material", material_size(material));
}

namespace {

/// A placeholder material of which only sizes are used. Its maps are labels, which need no conversion.
MaterialPtr stand_in(const Forecast& material, const Texts& maps) {
  std::vector<Map> out;
  for (const std::string& map : maps) {
    const ImageInfo info{.size = material.images.at(map).size.value(), .semantic = Semantic::data};
    const Digest recipe = Hasher().add("stand-in").add(info.size.width).add(info.size.height).digest();
    out.push_back({map, Image::computed(info, recipe, [](const Rect&, float*) {})});
  }
  return Material::make("", std::move(out));
}

/// The forecast of an atlas of materials with these maps; nullopt if a size is unknown.
std::optional<Forecast> sizes_in_atlas(const std::vector<Forecast>& materials, const Texts& maps, int gap,
                                       const ExemplarsOf& exemplars_of) {
  const auto has_size = [](const Forecast& material, const std::string& map) {
    const auto facts = material.images.find(map);
    return facts != material.images.end() && facts->second.size;
  };
  std::vector<MaterialPtr> stand_ins;
  for (const Forecast& m : materials) {
    if (maps.empty() || !std::ranges::all_of(maps, [&](const std::string& map) { return has_size(m, map); })) return {};
    stand_ins.push_back(stand_in(m, maps));
  }
  return forecast_of(make_atlas(exemplars_of(stand_ins), gap, Outside::clamp).material);
}

/// If possible maps could determine the size, it is unknown.
Forecast atlas_sizes(const std::vector<Forecast>& materials, int gap, const ExemplarsOf& exemplars_of) {
  const Forecast& first = materials.front();
  const auto is_known = [](const Forecast& m) { return m.possible_maps.has_value(); };
  if (!std::ranges::all_of(materials, is_known)) return {};
  Texts all = first.maps;
  for (const Forecast& m : materials)
    for (const Texts& maps : {m.maps, *m.possible_maps})
      for (const std::string& map : maps)
        if (std::ranges::find(all, map) == all.end()) all.push_back(map);
  const std::optional<Forecast> least = sizes_in_atlas(materials, first.maps, gap, exemplars_of);
  const std::optional<Forecast> most =
      all.size() == first.maps.size() ? least : sizes_in_atlas(materials, all, gap, exemplars_of);
  return least && most && material_size(*least) == material_size(*most) ? *most : Forecast{};
}

}  // namespace

OutputForecasts atlas_forecast(const std::vector<Forecast>& materials, int gap, const ExemplarsOf& exemplars_of) {
  const Forecast sizes = atlas_sizes(materials, gap, exemplars_of);
  const auto with_size = [&](const std::string& map, ImageFacts& facts) { facts.size = map_of(sizes, map).size; };
  const std::optional<Size> size = material_size(sizes);
  return {{"material", with_facts_changed(materials.front(), with_size)},
          {"mask", forecast_of_image(values_facts(size, Semantic::mask))},
          {"labels", forecast_of_image(values_facts(size, Semantic::guidance))}};
}

Exemplar masked_exemplar(const MaterialPtr& material, const ImagePtr& mask) {
  if (!mask) return {material, nullptr};
  ImageInfo info = mask->info();
  info.semantic = Semantic::mask;
  return {material, Image::redescribed(mask, info)};
}

}  // namespace terrazzo
