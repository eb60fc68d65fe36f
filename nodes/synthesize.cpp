#include "core/synthesis/synthesize.h"

#include "nodes/synthesis_params.h"

namespace terrazzo {

NodeType synthesize_node() {
  NodeType t;
  t.name = "synthesize";
  t.version = 3;
  t.category = "synthesis";
  t.summary = "Makes a uv map of any size from an index";
  t.help =
      "Decides for every output pixel which exemplar pixel it shows, coarse to fine, so that every neighbourhood of "
      "the result looks like one of the exemplar (appearance-space synthesis, Lefebvre & Hoppe 2006). The same index, "
      "size and seed give the same uv map on every machine. resolve_uv turns the uv map into maps.";
  t.inputs = {index_port()};
  t.outputs = {uv_output()};
  t.params = with_synthesis_params({result_size_param(), tileable_param()});
  t.check = check_synthesis_params;
  t.compute = [](NodeContext& node) {
    const auto index = node.input<Index>("index");
    node.output("uv", synthesize(*index, synthesis_options(node, *index), node.task()));
  };
  t.memory_hint = [](const NodeContext& node) { return synthesis_memory(node.size("size")); };
  return t;
}

}  // namespace terrazzo
