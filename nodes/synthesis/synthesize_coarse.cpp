#include "core/analysis/space/appearance_space.h"
#include "core/synthesis/steps.h"
#include "core/synthesis/synthesize.h"
#include "nodes/common/synthesis/analysis_memory.h"
#include "nodes/common/synthesis/synthesis_memory.h"
#include "nodes/common/synthesis/synthesis_params.h"
#include "nodes/common/synthesis/synthesis_steps.h"

namespace terrazzo {

NodeType synthesize_coarse_node() {
  NodeType t;
  t.name = "synthesize_coarse";
  t.category = "synthesis";
  t.version = synthesis_version;
  t.summary = "Makes the coarse levels of a surface too large to make at once";
  t.help =
      "The first part of synthesize: everything that depends on the surface as a whole. Connect it to \"coarse\" of "
      "synthesize, with the same surface, seed and other parameters, and make the surface part by part; machines that "
      "share a cache compute this stage once. The uv map is for synthesize only: it has half the surface's size, and "
      "gives the start of each 2x2 block of the finest level.";
  t.inputs = {index_port()};
  t.outputs = {{.name = "uv", .type = ValueType::uv_map, .help = "the coarse levels, for \"coarse\" of synthesize"}};
  t.params = with_synthesis_params(
      {surface_param("size", "Size of the whole surface.", 1), tileable_param(), whole_bricks_param()});
  t.steps = described_synthesis_steps();
  t.check = check_synthesis_params;
  t.compute = [](NodeContext& node) {
    const auto index = node.input<Index>("index");
    node.output("uv", coarse_uv(*index, synthesis_options(node, *index), node.task()));
  };
  t.infer = [](const Params& params, const InputForecasts& inputs) {
    const std::optional<Size> exemplar = inputs.at("index").front().size;
    if (!exemplar) return OutputForecasts{};
    const Size size = coarse_size(std::get<Size>(params.at("size")), appearance_levels(*exemplar));
    return OutputForecasts{{"uv", {.size = size, .exemplar = exemplar}}};
  };
  t.memory_hint = [](const NodeContext& node) { return size_t(coarse_memory(node.size("size"))); };
  t.memory_ahead = [](const Params& params, const InputForecasts& inputs) {
    const uint64_t held = index_memory.of(inputs.at("index").front());
    return held > 0 ? held + coarse_memory(std::get<Size>(params.at("size"))) : 0;
  };
  return t;
}

}  // namespace terrazzo
