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

namespace terrazzo {

namespace {

ExistingPixels placed(const UvMap& uv, Size size, std::array<int, 2> at) {
  ExistingPixels kept;
  kept.keep.resize(size_t(size.area()));
  kept.pixels.resize(size_t(size.area()));
  for (int y = 0; y < uv.size().height; y++)
    for (int x = 0; x < uv.size().width; x++) {
      const size_t to = size_t(y + at[1]) * size.width + size_t(x + at[0]);
      kept.keep[to] = Keep::always;
      kept.pixels[to] = uv.at(x, y);
    }
  return kept;
}

void compute_extend(NodeContext& node) {
  const auto index = node.input<Index>("index");
  const auto uv = node.input<UvMap>("uv");
  SynthesisOptions options = synthesis_options(node, *index);
  const Numbers& at = node.numbers("at");
  options.origin = {int(at[0]), int(at[1])};
  options.kept = placed(*uv, options.size, options.origin);
  warn_unless_repeats_fit(node, *index, options, "courses or tiles are bent, or cut, where the result wraps");
  node.output("uv", synthesize(*index, options, node.task()));
}

/// Throws Error unless the kept pixels fit into the result.
void require_room(const Params& params, Size kept) {
  const Size size = std::get<Size>(params.at("size"));
  const Numbers& at = std::get<Numbers>(params.at("at"));
  const Size room{size.width - kept.width, size.height - kept.height};
  if (room.width < 0 || room.height < 0)
    throw Error("size", fmt::format("expected at least the size of what is kept, {}; found {}", describe(kept),
                                    describe(size)));
  if (at[0] > room.width || at[1] > room.height)
    throw Error("at", fmt::format("expected at most [{}, {}], so that the {} pixels that are kept fit into {}; found "
                                  "[{}, {}]",
                                  room.width, room.height, describe(kept), describe(size), at[0], at[1]));
}

OutputForecasts infer_extend(const Params& params, const InputForecasts& inputs) {
  require_same_exemplar(inputs);
  if (const std::optional<Size> kept = inputs.at("uv").front().size) require_room(params, *kept);
  return {{"uv", {.size = std::get<Size>(params.at("size")), .exemplar = inputs.at("index").front().size}}};
}

std::vector<std::string> check_extend(const Params& params) {
  const auto& at = std::get<Numbers>(params.at("at"));
  const bool whole = at.size() == 2 && at[0] == std::floor(at[0]) && at[1] == std::floor(at[1]);
  std::vector<std::string> problems = check_synthesis_params(params);
  if (!whole) problems.push_back("\"at\": expected [x, y] in whole pixels");
  return problems;
}

}  // namespace

NodeType extend_node() {
  NodeType t;
  t.name = "extend";
  t.version = synthesis_version;
  t.category = "synthesis";
  t.summary = "Grows an existing result, keeping its pixels";
  t.help =
      "Places an earlier uv map from the same index inside a larger one and synthesizes the rest. Old pixels stay bit "
      "for bit in every map. If resolve_uv joins heights, connect the earlier result to `kept`, so that its heights "
      "stay.";
  t.inputs = {index_port(), {.name = "uv", .type = ValueType::uv_map, .help = "the result to grow"}};
  t.outputs = {uv_output()};
  t.params = with_synthesis_params({result_size_param(),
                                    {.name = "at",
                                     .type = ParamType::numbers,
                                     .fallback = Numbers{0, 0},
                                     .help = "Position of the kept result's top left pixel: [x, y].",
                                     .min = 0,
                                     .max = 32768,
                                     .unit = "pixels",
                                     .max_count = 2},
                                    tileable_param(),
                                    whole_bricks_between_kept_param()});
  t.check = check_extend;
  t.steps = described_synthesis_steps();
  t.infer = infer_extend;
  t.compute = compute_extend;
  t.memory_hint = [](const NodeContext& node) { return size_t(result_kept_memory.of(node.size("size"))); };
  t.memory_ahead = [](const Params& params, const InputForecasts& inputs) {
    return synthesis_ahead(inputs, result_kept_memory, std::get<Size>(params.at("size")));
  };
  return t;
}

}  // namespace terrazzo
