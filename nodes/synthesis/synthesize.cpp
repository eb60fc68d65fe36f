#include "core/synthesis/synthesize.h"

#include <fmt/format.h>

#include "core/analysis/space/appearance_space.h"
#include "core/exemplar/element_lattice.h"
#include "core/image/image_facts.h"
#include "core/metrics/long_lines.h"
#include "core/metrics/whole_elements.h"
#include "core/synthesis/steps.h"
#include "core/synthesis/steps/element_layout.h"
#include "nodes/common/shape_rules.h"
#include "nodes/common/synthesis/synthesis_memory.h"
#include "nodes/common/synthesis/synthesis_params.h"
#include "nodes/common/synthesis/synthesis_steps.h"

namespace terrazzo {

namespace {

/// The part of a surface that is synthesized.
struct Part {
  Size surface;
  Rect region;
  bool is_whole() const { return region == whole(surface); }
};

Part part_of(Size size, Size surface, const Numbers& origin) {
  if (surface.width == 0) surface.width = size.width;
  if (surface.height == 0) surface.height = size.height;
  return {surface, {int(origin.at(0)), int(origin.at(1)), size.width, size.height}};
}

Part part_of(const Params& params) {
  return part_of(std::get<Size>(params.at("size")), std::get<Size>(params.at("surface")),
                 std::get<Numbers>(params.at("origin")));
}

/// Says how many elements came out whole, and warns of results that are not to be trusted. What the exemplar's border
/// cuts cannot come out whole: of exemplars with too few others nothing is known.
void tell_of_elements(NodeContext& node, const Index& index, const SynthesisOptions& options, const UvMap& uv) {
  const Appearance& appearance = *index.appearance();
  const ElementsPtr& elements = appearance.elements();
  if (!elements || uv.size().area() < appearance.size().area()) return;
  if (!has_elements(appearance)) {
    if (repeats_in_result(appearance, options).lattice.rank < 2 && !lays_courses(appearance, options))
      node.warn(
          fmt::format("the exemplar's border cuts all but {} of its {} elements, too few to be laid as wholes: "
                      "they may be torn or melted together. An exemplar that shows more of them, or that tiles, "
                      "helps",
                      whole_elements(*elements, appearance.wraps()), elements->count));
    return;
  }
  const ShownElements shown = shown_elements(uv, *elements, node.task());
  const bool heaped = are_heaped(appearance), broken = shown.are_broken(heaped);
  const std::string counts = fmt::format("{} of {} elements are whole", shown.whole, shown.all);
  if (broken && (options.tile_x || options.tile_y) && lays_courses(appearance, options))
    node.note(counts + ", others are a little shorter or longer, so that courses end where the result does");
  else if (broken && !are_in_step(*elements, repeats_in_result(appearance, options).lattice, appearance.wraps()))
    node.warn(
        counts +
        ", the others are torn or melted together: look at them (the node `torn_elements` and --report mark them). "
        "An exemplar that shows more of them, or none that its border cuts, helps");
  else if (shown.lack_most())
    node.warn(
        fmt::format("{}, but {:.0f} % of the exemplar does not appear: elements that its border cuts are not "
                    "laid. An exemplar that shows more of them whole, or that tiles, helps",
                    counts, 100 * shown.missing));
  else if (shown.all > 0)
    node.note(fmt::format("{}{}; they show {} different ones", counts, heaped ? ", others lie partly under them" : "",
                          shown.distinct));
}

/// Warns of a result in which joints and edges end that go on in the exemplar. Unlike elements, they are always known.
void tell_of_lines(NodeContext& node, const Index& index, const UvMap& uv) {
  const LongLines lines = long_lines(uv, *index.appearance(), node.task());
  if (lines.are_broken())
    node.warn(fmt::format(
        "straight joints or edges are broken: of those that go on along half of the exemplar, {:.0f} % do so here. An "
        "exemplar that shows more of its panels, or that tiles, helps",
        100 * lines.kept));
}

void compute_synthesize(NodeContext& node) {
  const auto index = node.input<Index>("index");
  const auto coarse = node.optional_input<UvMap>("coarse");
  const Part part = part_of(node.params());
  SynthesisOptions options = synthesis_options(node, *index);
  options.size = part.surface;
  warn_unless_repeats_fit(node, *index, options, "they are stretched to wrap around and joints may jog");
  const UvMapPtr uv = !coarse && part.is_whole()
                          ? synthesize(*index, options, node.task())
                          : refine(*index, coarse ? *coarse : *coarse_uv(*index, options, node.task()), options,
                                   part.region, node.task());
  tell_of_parts(node, *index, *uv, part.is_whole());
  warn_of_less_surface(node, *index, part.surface);
  if (options.quality != Quality::draft) tell_of_elements(node, *index, options, *uv);  // a draft lays none
  tell_of_lines(node, *index, *uv);
  node.output("uv", uv);
}

std::vector<std::string> check_synthesize(const Params& params) {
  std::vector<std::string> problems = check_synthesis_params(params);
  const Numbers& origin = std::get<Numbers>(params.at("origin"));
  if (origin.size() != 2 || origin[0] != int(origin[0]) || origin[1] != int(origin[1])) {
    problems.push_back("\"origin\": expected two whole numbers, [x, y]");
    return problems;
  }
  const Part part = part_of(params);
  const Size surface = part.surface;
  if (part.region.width > surface.width || part.region.height > surface.height)
    problems.push_back(fmt::format("\"surface\": expected at least the size of the result, {}, found {}",
                                   describe(Size{part.region.width, part.region.height}), describe(surface)));
  else if (part.region.x >= surface.width || part.region.y >= surface.height)
    problems.push_back(
        fmt::format("\"origin\": expected a place on the surface, which has {}, found ({}, {}); "
                    "\"surface\" says how large it is as a whole",
                    describe(surface), part.region.x, part.region.y));
  return problems;
}

/// Memory of the coarse levels, if they are synthesized here.
uint64_t memory_of_coarse(const Part& part, bool has_coarse) {
  return part.is_whole() || has_coarse ? 0 : coarse_memory(part.surface);
}

size_t memory(const NodeContext& node) {
  return new_pixels_memory.of(node.size("size")) +
         memory_of_coarse(part_of(node.params()), node.optional_input<UvMap>("coarse") != nullptr);
}

uint64_t memory_ahead_of_synthesize(const Params& params, const InputForecasts& inputs) {
  const uint64_t least = synthesis_ahead(inputs, new_pixels_memory, std::get<Size>(params.at("size")));
  return least > 0 ? least + memory_of_coarse(part_of(params), wires_at(inputs, "coarse") > 0) : 0;
}

OutputForecasts infer_synthesize(const Params& params, const InputForecasts& inputs) {
  const Part part = part_of(params);
  const std::optional<Size> exemplar = inputs.at("index").front().size;
  const Forecast* coarse = forecast_at(inputs, "coarse");
  if (coarse && coarse->size && exemplar)
    require_coarse_size(part.surface, coarse_size(part.surface, appearance_levels(*exemplar)), *coarse->size);
  return {{"uv", {.size = Size{part.region.width, part.region.height}, .exemplar = exemplar}}};
}

}  // namespace

NodeType synthesize_node() {
  NodeType t;
  t.name = "synthesize";
  t.version = synthesis_version;
  t.category = "synthesis";
  t.summary = "Makes a uv map of any size from an index";
  t.help =
      "Decides coarse to fine which exemplar pixel every output pixel shows, so that every neighbourhood of the result "
      "looks like one of the exemplar (appearance-space synthesis, Lefebvre & Hoppe 2006). The same index, size and "
      "seed give the same uv map on every machine. resolve_uv turns the uv map into maps. A surface too large to make "
      "at once can be made in parts: give all of them the same \"surface\" and other parameters, and each its "
      "\"origin\". They fit together to the bit, made on any machine and in any order; see examples/huge-surface.json.";
  t.inputs = {index_port(),
              {.name = "coarse",
               .type = ValueType::uv_map,
               .help = "the surface's coarse levels from synthesize_coarse, so that parts do not compute them again",
               .optional = true}};
  t.outputs = {uv_output()};
  t.params = with_synthesis_params(
      {result_size_param(),
       tileable_param(),
       whole_bricks_param(),
       surface_param("surface", "Size of the whole surface that the result is a part of; 0 for the result's own.", 0),
       {.name = "origin",
        .type = ParamType::numbers,
        .fallback = Numbers{0, 0},
        .help = "Position of the result's top left pixel on the surface: [x, y]. On a tileable surface, parts may "
                "cross the right and bottom border.",
        .min = 0,
        .max = largest_surface - 1,
        .unit = "pixels",
        .min_count = 2,
        .max_count = 2}});
  t.check = check_synthesize;
  t.steps = described_synthesis_steps();
  t.infer = infer_synthesize;
  t.compute = compute_synthesize;
  t.memory_hint = memory;
  t.memory_ahead = memory_ahead_of_synthesize;
  return t;
}

}  // namespace terrazzo
