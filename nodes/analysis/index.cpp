#include "core/analysis/space/k_coherence.h"
#include "core/node/node.h"
#include "nodes/common/synthesis/analysis_memory.h"

namespace terrazzo {

NodeType index_node() {
  NodeType t;
  t.name = "index";
  t.version = 7;
  t.category = "analysis";
  t.summary = "Finds similar pixels for each exemplar pixel";
  t.help =
      "For every pixel of every level but the finest, a few positions with similar neighbourhoods (k-coherent "
      "candidates; Tong et al. 2002). The index is all that synthesis needs, for any size and seed.";
  t.inputs = {{.name = "appearance", .type = ValueType::appearance, .help = "the exemplar in appearance space"}};
  t.outputs = {{.name = "index", .type = ValueType::index, .help = "the appearance with its similar pixels"}};
  t.params = {{.name = "similar",
               .type = ParamType::integer,
               .fallback = 3,
               .help = "Similar pixels per pixel. More gives synthesis more choice, and takes longer.",
               .min = 1,
               .max = most_similar}};
  t.compute = [](NodeContext& node) {
    node.output("index", make_index(node.input<Appearance>("appearance"), int(node.integer("similar")), node.task()));
  };
  t.infer = [](const Params&, const InputForecasts& inputs) {
    return OutputForecasts{{"index", {.size = inputs.at("appearance").front().size}}};
  };
  t.memory_ahead = [](const Params&, const InputForecasts& inputs) {
    return index_memory.of(inputs.at("appearance").front());
  };
  t.memory_hint = [](const NodeContext& node) {
    return size_t(node.input<Appearance>("appearance")->size().area()) * 140;
  };
  return t;
}

}  // namespace terrazzo
