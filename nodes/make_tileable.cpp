#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/error.h"
#include "core/image_ops.h"
#include "core/synthesis/kept.h"
#include "nodes/synthesis_params.h"

namespace terrazzo {

namespace {

/// The width of the border along a side of that length; 0 where the result need not wrap.
int border_pixels(double border, int side, bool wraps) {
  if (!wraps) return 0;
  const int pixels = std::max(1, int(std::floor((border < 1 ? border * side : border) + 0.5)));
  if (2 * pixels >= side)
    throw Error("border", fmt::format("expected less than half the exemplar's side of {} pixels, so that something is "
                                      "kept; found {} pixels",
                                      side, pixels));
  return pixels;
}

KeptPixels interior(Size size, int border_x, int border_y) {
  KeptPixels kept;
  kept.keep.reserve(size_t(size.area()));
  kept.pixels.reserve(size_t(size.area()));
  for (int y = 0; y < size.height; y++)
    for (int x = 0; x < size.width; x++) {
      kept.pixels.push_back({uint16_t(x), uint16_t(y)});
      kept.keep.push_back(x >= border_x && x < size.width - border_x && y >= border_y && y < size.height - border_y);
    }
  return kept;
}

/// White where pixels are made anew.
ImagePtr border_mask(const KeptPixels& kept, Size size) {
  std::vector<float> mask;
  for (const uint8_t keep : kept.keep) mask.push_back(keep ? 0.0f : 1.0f);
  return Image::from_floats({.size = size, .semantic = Semantic::mask, .depth = Depth::u8}, std::move(mask));
}

void compute(NodeContext& node) {
  const auto index = node.input<Index>("index");
  SynthesisOptions options = synthesis_options(node, *index);
  const std::string& directions = node.text("directions");
  options.tile_x = directions != "y";
  options.tile_y = directions != "x";
  const Lattice& lattice = index->appearance()->lattice();
  if (node.text("fit") == "repeats")
    options.size = lattice.largest_fitting(options.size, options.tile_x, options.tile_y).value_or(options.size);
  if (const Size exemplar = index->appearance()->size(); options.size != exemplar)
    node.note(
        fmt::format("the exemplar of {} pixels repeats: the result has {}, so that it holds a whole number of "
                    "repeats; set `fit` to \"size\" to keep {} and cut some repeats short",
                    describe(exemplar), describe(options.size), describe(exemplar)));
  const double border = node.number("border");
  options.kept = interior(options.size, border_pixels(border, options.size.width, options.tile_x),
                          border_pixels(border, options.size.height, options.tile_y));
  if (!lattice.fits(options.size, options.tile_x, options.tile_y))
    node.note(
        "the result does not hold a whole number of the exemplar's repeats: some will be cut short in the border");
  node.output("border", border_mask(options.kept, options.size));
  node.output("uv", synthesize(*index, options, node.task()));
}

}  // namespace

NodeType make_tileable_node() {
  NodeType t;
  t.name = "make_tileable";
  t.version = 12;
  t.category = "synthesis";
  t.summary = "Keeps an exemplar's interior and makes its border wrap";
  t.help =
      "The result has the exemplar's size, or a little less where the exemplar repeats. Its interior stays exactly as "
      "it is; a border is made anew from the "
      "exemplar so that opposite sides, and all four corners, fit together in every map. resolve_uv shows it; where "
      "that joins heights, those of the interior stay if it "
      "is given the exemplar as `kept` and `border` as `holes`.";
  t.inputs = {index_port()};
  t.outputs = {uv_output(),
               {.name = "border", .type = ValueType::image, .help = "a mask: white where pixels are made anew"}};
  t.params = with_synthesis_params({
      {.name = "border",
       .type = ParamType::number,
       .fallback = 0.125,
       .help = "Width of the border that is made anew, on each side: below 1 a part of the side, else pixels. Wider "
               "borders have more room to lead one side into the other.",
       .min = 0.01,
       .max = 32768,
       .unit = "pixels or part of the side"},
      {.name = "directions",
       .type = ParamType::choice,
       .fallback = "xy",
       .help = "Directions in which the result wraps around.",
       .choices = {"x", "y", "xy"}},
      {.name = "fit",
       .type = ParamType::choice,
       .fallback = "repeats",
       .help = "For exemplars that repeat: \"repeats\" makes the result the largest that holds a whole number of "
               "repeats, if over half of the exemplar does, \"size\" keeps the exemplar's size and cuts some repeats "
               "short.",
       .choices = {"repeats", "size"}},
  });
  t.check = check_synthesis_params;
  t.compute = compute;
  t.memory_hint = [](const NodeContext& node) {
    return 3 * synthesis_memory(node.input<Index>("index")->appearance()->size());
  };
  return t;
}

}  // namespace terrazzo
