#include "core/stochastic/noise_by_example.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/image/image_facts.h"
#include "nodes/common/exemplar_tiles.h"
#include "nodes/common/node_helpers.h"
#include "nodes/common/shape_rules.h"
#include "nodes/common/synthesis/synthesis_params.h"

namespace terrazzo {

namespace {

constexpr double farthest_origin = 1e9;

std::vector<Param> noise_by_example_params() {
  return {
      result_size_param(),
      tileable_param(),
      surface_param("surface",
                    "After how many pixels the surface wraps, in the directions of `tileable`; 0 for the result's "
                    "own size.",
                    0),
      {.name = "origin",
       .type = ParamType::numbers,
       .fallback = Numbers{0, 0},
       .help = "Position of the result's top left pixel on the surface, which goes on in all directions: [x, y].",
       .min = -farthest_origin,
       .max = farthest_origin,
       .unit = "pixels",
       .min_count = 2,
       .max_count = 2},
      {.name = "seed",
       .type = ParamType::integer,
       .fallback = 1,
       .help = "Another number gives another arrangement of the same material.",
       .min = 0},
      {.name = "cell",
       .type = ParamType::number,
       .fallback = 0.25,
       .help = "Distance between samples: below 1 a share of the exemplar's shorter side, else pixels. Larger cells "
               "keep larger features and take them from fewer places of an exemplar that does not tile.",
       .min = 0.001,
       .max = 16384},
      tiles_param()};
}

/// The requested cell in whole pixels.
int asked_cell(double cell, Size exemplar) {
  const double pixels = cell < 1 ? cell * std::min(exemplar.width, exemplar.height) : cell;
  return std::max(1, int(pixels + 0.5));
}

int fitting_cell(NodeContext& node, Size exemplar, bool tiles) {
  const int asked = asked_cell(node.number("cell"), exemplar), largest = largest_cell(exemplar, tiles);
  if (asked > largest)
    node.warn(fmt::format("\"cell\": samples of {} pixels do not fit into an exemplar of {}{}; {} pixels are used",
                          asked, describe(exemplar), tiles ? "" : " that does not tile", largest));
  return std::min(asked, largest);
}

GridSurface surface_of(const NodeContext& node) {
  const std::string& tileable = node.text("tileable");
  const Size own = node.size("size"), surface = node.size("surface");
  return {.size{surface.width > 0 ? surface.width : own.width, surface.height > 0 ? surface.height : own.height},
          .wraps_x = tileable == "x" || tileable == "xy",
          .wraps_y = tileable == "y" || tileable == "xy"};
}

void compute_noise_by_example(NodeContext& node) {
  const auto material = node.input<Material>("material");
  const Numbers& origin = node.numbers("origin");
  const bool tiles = exemplar_tiles(node, *material);
  const NoiseByExample options{.size = node.size("size"),
                               .origin = {int64_t(origin[0]), int64_t(origin[1])},
                               .surface = surface_of(node),
                               .cell = fitting_cell(node, material->size(), tiles),
                               .seed = uint64_t(node.integer("seed")),
                               .exemplar_tiles = tiles};
  node.output("material", noise_by_example(*material, options, node.task()));
}

std::vector<std::string> check_noise_by_example(const Params& params) {
  const Numbers& origin = std::get<Numbers>(params.at("origin"));
  if (std::ranges::all_of(origin, [](double v) { return v == std::floor(v); })) return {};
  return {"\"origin\": expected two whole numbers, [x, y]"};
}

/// Per pixel of the exemplar: at most one component per channel (label maps are held unchanged), and a copy of one
/// component while its histogram is computed.
uint64_t memory_of(Size exemplar, int channels) {
  return uint64_t(exemplar.area()) * uint64_t(channels + 1) * sizeof(float);
}

size_t memory_of_noise_by_example(const NodeContext& node) {
  const auto material = node.input<Material>("material");
  int channels = 0;
  for (const Map& m : material->maps()) channels += m.image->channels();
  return memory_of(material->size(), channels);
}

uint64_t memory_ahead_of_noise_by_example(const Params&, const InputForecasts& inputs) {
  const Forecast& material = inputs.at("material").front();
  const std::optional<Size> size = material_size(material);
  if (!size) return 0;
  int channels = 0;
  for (const std::string& name : material.maps) channels += map_of(material, name).channels.value_or(1);
  return memory_of(*size, channels);
}

OutputForecasts infer_noise_by_example(const Params& params, const InputForecasts& inputs) {
  preflight_one_shape("material", inputs);
  return {{"material", with_facts_changed(inputs.at("material").front(), [&](const std::string&, ImageFacts& facts) {
             facts.size = std::get<Size>(params.at("size"));
           })}};
}

}  // namespace

NodeType noise_by_example_node() {
  NodeType t;
  t.name = "noise_by_example";
  t.category = "synthesis";
  t.version = 5;
  t.summary = "Makes a surface of any size from an exemplar without structure, without a layout";
  t.help =
      "For sand, soil, plaster, granite, fine gravel: samples of the exemplar at random places are blended, three at "
      "every pixel, with their contrast kept and their histogram restored (Heitz & Neyret 2018; Deliot & Heitz 2019). "
      "All maps show the same places with the same weights, so they agree; normals are blended as vectors. Masks and "
      "data, which may be labels, are not blended: they show the place of the greatest weight. Features that are to "
      "stay whole, such as stones, blades of grass and joints, are lost: use `synthesize` for them. No index is needed "
      "and pixels are computed on demand, so the size costs nothing until they are read. The surface goes on "
      "in all directions: `origin` shows any part of it, and parts fit together to the bit, made on any machine and in "
      "any order.";
  t.inputs = {material_port("material", "the exemplar, with all maps wanted")};
  t.outputs = {{.name = "material", .type = ValueType::material, .help = "the maps, all in the size asked for"}};
  t.params = noise_by_example_params();
  t.persist = Persist::derived;
  t.check = check_noise_by_example;
  t.memory_hint = memory_of_noise_by_example;
  t.memory_ahead = memory_ahead_of_noise_by_example;
  t.compute = compute_noise_by_example;
  t.infer = infer_noise_by_example;
  return t;
}

}  // namespace terrazzo
