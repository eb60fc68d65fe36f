#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/image/image_facts.h"
#include "core/synthesis/state/fixed_pixels.h"
#include "core/synthesis/steps.h"
#include "nodes/common/shape_rules.h"
#include "nodes/common/synthesis/synthesis_memory.h"
#include "nodes/common/synthesis/synthesis_params.h"
#include "nodes/common/synthesis/synthesis_steps.h"
#include "nodes/common/synthesis/wrapping_size.h"

namespace terrazzo {

namespace {

/// The width of the border along a side of this length; 0 if the result need not wrap.
int border_pixels(double border, int side, bool wraps) {
  if (!wraps) return 0;
  const int pixels = std::max(1, int(std::floor((border < 1 ? border * side : border) + 0.5)));
  if (2 * pixels >= side)
    throw Error("border", fmt::format("expected less than half the exemplar's side of {} pixels, so that something is "
                                      "kept; found {} pixels",
                                      side, pixels));
  return pixels;
}

/// The exemplar within a result of this size. Most of the border is kept at first, so that the seam between old and new
/// pixels is not straight.
ExistingPixels interior(Size exemplar, Size result, Size border) {
  const auto keep = [](int x, int side, int border) {
    const int inside = std::min(x, side - 1 - x);
    return inside >= border ? Keep::always : inside >= border / 4 ? Keep::at_first : Keep::never;
  };
  const Size shown{std::min(exemplar.width, result.width), std::min(exemplar.height, result.height)};
  ExistingPixels kept;
  kept.keep.reserve(size_t(result.area()));
  kept.pixels.reserve(size_t(result.area()));
  for (int y = 0; y < result.height; y++)
    for (int x = 0; x < result.width; x++) {
      kept.pixels.push_back({uint16_t(std::min(x, shown.width - 1)), uint16_t(std::min(y, shown.height - 1))});
      kept.keep.push_back(std::min(keep(x, shown.width, border.width), keep(y, shown.height, border.height)));
    }
  return kept;
}

/// Outputs an exemplar unchanged that already wraps.
void leave(NodeContext& node, const Index& index) {
  const Size size = index.appearance()->size();
  node.note(
      "the exemplar already tiles and stays as it is; to replace its border anyway, set \"tiles\" to \"no\" where it "
      "is analysed, in the stock graph by --set tiles=no");
  const ExistingPixels kept = interior(size, size, {0, 0});
  const UvMapPtr uv = UvMap::make(size, size, kept.pixels, {true, true, true}, index.appearance()->fingerprint());
  node.output("border", new_pixels_mask(*uv, kept));
  node.output("uv", uv);
}

void compute_make_tileable(NodeContext& node) {
  const auto index = node.input<Index>("index");
  if (index->appearance()->wraps()) return leave(node, *index);
  SynthesisOptions options = synthesis_options(node, *index);
  options.whole_bricks = false;  // kept pixels end in cut elements that cannot be continued
  const std::string& directions = node.text("directions");
  options.tile_x = directions != "y";
  options.tile_y = directions != "x";
  const Size exemplar = index->appearance()->size();
  const Size border{border_pixels(node.number("border"), exemplar.width, options.tile_x),
                    border_pixels(node.number("border"), exemplar.height, options.tile_y)};
  node.note(
      "the exemplar does not seem to tile, so its border is replaced; if it does tile, set \"tiles\" to \"yes\" where "
      "it is analysed, in the stock graph by --set tiles=yes");
  const Lattice& lattice = index->appearance()->lattice();
  const Size fitting =
      best_wrapping_size(lattice, exemplar, options.tile_x, options.tile_y, {2 * border.width, 2 * border.height});
  if (node.text("fit") == "repeats") options.size = fitting;
  options.kept = interior(exemplar, options.size, border);
  if (options.size != exemplar)
    node.note(
        fmt::format("the exemplar of {} pixels repeats: the result has {}, so that whole repeats wrap around; set "
                    "\"fit\" to \"size\" to keep {} and bend repeats in the border instead",
                    describe(exemplar), describe(options.size), describe(exemplar)));
  const Size room{2 * border.width + std::max(0, options.size.width - exemplar.width),
                  2 * border.height + std::max(0, options.size.height - exemplar.height)};
  const double bent = lattice.bent(options.size, options.tile_x, options.tile_y, room);
  const std::string how = fmt::format(
      "to wrap around, repeats are bent by {:.0f} % in the border; a wider border bends them less{}", 100 * bent,
      options.size == fitting
          ? ""
          : fmt::format(", and so does \"fit\": \"repeats\", which makes the result {}", describe(fitting)));
  if (bent > Lattice::most_bent())
    node.warn(how);
  else if (bent > lattice.unseen_bend())
    node.note(how);
  const UvMapPtr uv = synthesize(*index, options, node.task());
  node.output("border", new_pixels_mask(*uv, options.kept));
  node.output("uv", uv);
}

OutputForecasts infer_make_tileable(const Params& params, const InputForecasts& inputs) {
  const std::optional<Size> exemplar = inputs.at("index").front().size;
  // The size may change slightly to fit whole repeats.
  const bool stays = std::get<std::string>(params.at("fit")) == "size";
  const std::optional<Size> size = stays ? exemplar : std::nullopt;
  return {{"uv", {.size = size, .exemplar = exemplar}},
          {"border", forecast_of_image(values_facts(size, Semantic::mask))}};
}

std::vector<std::string> check_make_tileable(const Params& params) {
  std::vector<std::string> problems = check_synthesis_params(params);
  const double border = std::get<double>(params.at("border"));
  if (border >= 0.5 && border < 1)
    problems.push_back(
        fmt::format("\"border\": expected less than 0.5 of the side, so that something is kept between "
                    "two borders, or at least 1 pixel; found {}",
                    border));
  return problems;
}

}  // namespace

NodeType make_tileable_node() {
  NodeType t;
  t.name = "make_tileable";
  t.version = synthesis_version;
  t.category = "synthesis";
  t.summary = "Makes an exemplar tileable by replacing its border";
  t.help =
      "The interior stays exactly as it is; the border is synthesized so that opposite sides, and all four corners, "
      "fit together in every map. Within the border the seam between old and new follows joints and cracks. The result "
      "has the exemplar's size, or nearly so if the exemplar repeats. An exemplar that already tiles stays as it is. "
      "If resolve_uv joins heights, connect the exemplar to `kept` and `border` to `holes`, so that the interior's "
      "heights stay.";
  t.inputs = {index_port()};
  t.outputs = {uv_output(), {.name = "border", .type = ValueType::image, .help = "a mask: white where pixels are new"}};
  t.params = with_synthesis_params({
      {.name = "border",
       .type = ParamType::number,
       .fallback = 0.125,
       .help = "Width of the new border on each side: below 1 a share of the side, else pixels. Wider borders give a "
               "smoother transition and keep less.",
       .min = 0.01,
       .max = 32768,
       .unit = "pixels or share of the side"},
      {.name = "directions",
       .type = ParamType::choice,
       .fallback = "xy",
       .help = "Directions in which the result wraps around.",
       .choices = {"x", "y", "xy"}},
      {.name = "fit",
       .type = ParamType::choice,
       .fallback = "repeats",
       .help = "For exemplars that repeat: repeats makes the result a little smaller or larger, so that it holds whole "
               "repeats; size keeps the exemplar's size and stretches repeats within the border.",
       .choices = {"repeats", "size"}},
  });
  t.check = check_make_tileable;
  t.steps = described_synthesis_steps();
  t.infer = infer_make_tileable;
  t.compute = compute_make_tileable;
  t.memory_hint = [](const NodeContext& node) {
    return size_t(exemplar_kept_memory.of(node.input<Index>("index")->appearance()->size()));
  };
  t.memory_ahead = [](const Params&, const InputForecasts& inputs) {
    return synthesis_ahead(inputs, exemplar_kept_memory, inputs.at("index").front().size);
  };
  return t;
}

}  // namespace terrazzo
