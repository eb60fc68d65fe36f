#include "core/node.h"
#include "core/resolve.h"

namespace terrazzo {

NodeType resolve_uv_node() {
  NodeType t;
  t.name = "resolve_uv";
  t.category = "synthesis";
  t.summary = "Shows a material through a uv map";
  t.help =
      "Every output pixel of every map is exactly the exemplar pixel that the uv map names, so maps cannot drift "
      "apart. "
      "Pixels are looked up when a later node pulls them; nothing is held in memory.";
  t.inputs = {{.name = "uv", .type = ValueType::uv_map, .help = "which exemplar pixel each output pixel shows"},
              {.name = "material", .type = ValueType::material, .help = "the exemplar, with all maps that are wanted"}};
  t.outputs = {{.name = "material", .type = ValueType::material, .help = "the maps in the uv map's size"}};
  t.persist = Persist::derived;
  t.compute = [](NodeContext& node) {
    node.output("material", resolved(*node.input<Material>("material"), node.input<UvMap>("uv")));
  };
  return t;
}

}  // namespace terrazzo
