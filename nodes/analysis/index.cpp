#include "core/analysis/space/k_coherence.h"
#include "core/node/node.h"

namespace terrazzo {

NodeType index_node() {
  NodeType t;
  t.name = "index";
  t.version = 6;
  t.category = "analysis";
  t.summary = "Finds each exemplar pixel's similar pixels";
  t.help =
      "For every pixel of every level but the finest, a few positions whose surroundings look alike (the k-coherent "
      "candidates of "
      "Tong et al. 2002). The result "
      "is all that synthesis needs; it does not depend on the size or seed of what will be made.";
  t.inputs = {{.name = "appearance", .type = ValueType::appearance, .help = "the exemplar in appearance space"}};
  t.outputs = {{.name = "index", .type = ValueType::index, .help = "the appearance with its similar sets"}};
  t.params = {{.name = "similar",
               .type = ParamType::integer,
               .fallback = 3,
               .help = "Similar pixels kept per pixel.",
               .min = 1,
               .max = most_similar}};
  t.compute = [](NodeContext& node) {
    node.output("index", make_index(node.input<Appearance>("appearance"), int(node.integer("similar")), node.task()));
  };
  t.memory_hint = [](const NodeContext& node) {
    return size_t(node.input<Appearance>("appearance")->size().area()) * 140;
  };
  return t;
}

}  // namespace terrazzo
