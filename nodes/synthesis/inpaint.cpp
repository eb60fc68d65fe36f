#include <algorithm>

#include "core/base/disjoint_sets.h"
#include "core/base/error.h"
#include "core/image/image_facts.h"
#include "core/image/image_ops.h"
#include "core/numeric/distance_transform.h"
#include "core/synthesis/state/fixed_pixels.h"
#include "core/synthesis/steps.h"
#include "nodes/common/shape_rules.h"
#include "nodes/common/synthesis/synthesis_memory.h"
#include "nodes/common/synthesis/synthesis_params.h"
#include "nodes/common/synthesis/synthesis_steps.h"

namespace terrazzo {

namespace {

/// Half the maximum width of each hole.
class HalfWidths {
 public:
  HalfWidths(const std::vector<uint8_t>& hole, Size size, bool wraps) : holes_(hole.size()), widest_(hole.size()) {
    std::vector<uint8_t> sound(hole.size());
    for (size_t i = 0; i < hole.size(); i++) {
      sound[i] = !hole[i];
      if (!hole[i]) continue;
      const auto width = size_t(size.width);
      if (i % width > 0 && hole[i - 1]) holes_.join(uint32_t(i), uint32_t(i - 1));
      if (i >= width && hole[i - width]) holes_.join(uint32_t(i), uint32_t(i - width));
    }
    const std::vector<int64_t> inside = squared_distances(sound, size, wraps);
    for (size_t i = 0; i < hole.size(); i++) {
      int64_t& most = widest_[holes_.find(uint32_t(i))];
      most = std::max(most, inside[i]);
    }
  }
  /// Squared, of the hole that a pixel is part of.
  int64_t squared(uint32_t pixel) { return widest_[holes_.find(pixel)]; }

 private:
  DisjointSets holes_;
  std::vector<int64_t> widest_;
};

/// The pixels to keep. Pixels within `margin` of a hole, but no farther than the hole's width, may be replaced.
std::vector<Keep> kept_around(const std::vector<uint8_t>& hole, Size size, bool wraps, double margin) {
  std::vector<Keep> keep(hole.size(), Keep::always);
  for (size_t i = 0; i < hole.size(); i++)
    if (hole[i]) keep[i] = Keep::never;
  if (margin <= 0 || std::ranges::none_of(hole, [](uint8_t h) { return h; })) return keep;
  HalfWidths half_widths(hole, size, wraps);
  const std::vector<int64_t> squared = squared_distances(hole, size, wraps);
  const std::vector<uint32_t> nearest = nearest_set(hole, size, wraps);
  for (size_t i = 0; i < hole.size(); i++)
    if (!hole[i] && double(squared[i]) <= margin * margin && squared[i] <= 4 * half_widths.squared(nearest[i]))
      keep[i] = Keep::at_first;
  return keep;
}

/// The existing pixels outside the holes, from `uv` or the exemplar itself. Pixels within `margin` of a hole may be
/// replaced.
ExistingPixels outside_holes(const UvMap* uv, const ImagePtr& holes, Size size, bool wraps, double margin) {
  std::vector<uint8_t> hole;
  hole.reserve(size_t(size.area()));
  for_each_strip(*nearest_at_size(holes, size), [&](const Rect& r, const float* v) {
    for (int64_t i = 0; i < r.area(); i++) hole.push_back(v[i * holes->channels()] > 0.5f);
  });
  ExistingPixels kept{{}, kept_around(hole, size, wraps, margin)};
  kept.pixels.reserve(hole.size());
  if (uv) {
    kept.pixels = uv->pixels();
    return kept;
  }
  for (int y = 0; y < size.height; y++)
    for (int x = 0; x < size.width; x++) kept.pixels.push_back({uint16_t(x), uint16_t(y)});
  return kept;
}

Param wrapping_param() {
  Param p = tileable_param();
  p.choices.insert(p.choices.begin(), "auto");
  p.fallback = "auto";
  p.help += " auto: as the exemplar does, by \"tiles\" of its analysis, or as \"uv\" does.";
  return p;
}

void compute_inpaint(NodeContext& node) {
  const auto index = node.input<Index>("index");
  const auto uv = node.optional_input<UvMap>("uv");
  const auto holes = node.input<Image>("mask");
  SynthesisOptions options = synthesis_options(node, *index);
  options.whole_bricks = false;  // kept pixels end in cut elements that cannot be continued
  if (uv) {
    options.size = uv->size();
    options.tile_x |= uv->wraps().x;
    options.tile_y |= uv->wraps().y;
  } else if (node.text("tileable") == "auto" && index->appearance()->wraps()) {
    options.tile_x = options.tile_y = true;
    node.note("the exemplar tiles, and so does the result; \"tileable\" set to none leaves opposite borders apart");
  }
  const double margin = node.number("margin");
  options.kept = outside_holes(uv.get(), holes, options.size, options.tile_x && options.tile_y,
                               margin < 1 ? margin * std::min(options.size.width, options.size.height) : margin);
  const std::vector<Keep>& keep = options.kept.keep;
  if (std::ranges::all_of(keep, [](Keep k) { return k == Keep::never; }))
    throw Error("mask",
                "the holes cover everything, so that nothing is kept; white (above 0.5) is filled and black stays. "
                "Invert the mask (levels) if it is the other way round; for wholly new material use \"synthesize\"");
  const UvMapPtr filled = synthesize(*index, options, node.task());
  node.output("filled", new_pixels_mask(*filled, options.kept));
  node.output("uv", filled);
}

OutputForecasts infer_inpaint(const Params&, const InputForecasts& inputs) {
  require_same_exemplar(inputs);
  const Forecast* uv = forecast_at(inputs, "uv");
  const std::optional<Size> exemplar = inputs.at("index").front().size, size = uv ? uv->size : exemplar;
  require_shape("mask", image_at(inputs, "mask"), uv ? "the uv map" : "the exemplar", size);
  return {{"uv", {.size = size, .exemplar = exemplar}},
          {"filled", forecast_of_image(values_facts(size, Semantic::mask))}};
}

}  // namespace

NodeType inpaint_node() {
  NodeType t;
  t.name = "inpaint";
  t.version = synthesis_version;
  t.category = "synthesis";
  t.summary = "Fills holes and keeps everything else to the pixel";
  t.help =
      "Fills all maps at once, through one uv map: pixels outside the holes and a margin around them stay exactly as "
      "they are, those inside are filled with material from elsewhere in the exemplar. Within the margin the seam "
      "between old and new follows joints and cracks. Without \"uv\" the exemplar itself is repaired; connect the "
      "inverted mask to weight, so that nothing is taken from the holes. With \"uv\" parts of an earlier result are "
      "replaced, and it wraps as before. If resolve_uv joins heights, connect what was there to `kept` and `filled` to "
      "`holes`, so that old heights stay.";
  t.inputs = {index_port(),
              {.name = "mask",
               .type = ValueType::image,
               .help = "the holes: white (above 0.5) is filled, black stays. The aspect ratio of what is filled, at "
                       "any size; only the first channel counts"},
              {.name = "uv",
               .type = ValueType::uv_map,
               .help = "an earlier result to fill; the exemplar itself if not connected",
               .optional = true}};
  t.outputs = {uv_output(), {.name = "filled", .type = ValueType::image, .help = "a mask: white where pixels are new"}};
  t.params = with_synthesis_params(
      {{.name = "margin",
        .type = ParamType::number,
        .fallback = 0.0625,
        .help = "How far around a hole pixels may change, so that its outline does not show: below 1 a share of the "
                "shorter side, else pixels; never more than the width of the hole (for scratches). Half a brick or "
                "tile suits walls and floors; 0 keeps every pixel outside the holes.",
        .min = 0,
        .max = 32768,
        .unit = "pixels or share of the side"},
       wrapping_param()});
  t.check = check_synthesis_params;
  t.steps = described_synthesis_steps();
  t.infer = infer_inpaint;
  t.compute = compute_inpaint;
  t.memory_hint = [](const NodeContext& node) {
    const auto uv = node.optional_input<UvMap>("uv");
    return size_t(uv ? result_filled_memory.of(uv->size())
                     : exemplar_kept_memory.of(node.input<Index>("index")->appearance()->size()));
  };
  t.memory_ahead = [](const Params&, const InputForecasts& inputs) {
    const Forecast* uv = forecast_at(inputs, "uv");
    return uv ? synthesis_ahead(inputs, result_filled_memory, uv->size)
              : synthesis_ahead(inputs, exemplar_kept_memory, inputs.at("index").front().size);
  };
  return t;
}

}  // namespace terrazzo
