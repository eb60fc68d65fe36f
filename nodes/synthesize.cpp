#include "core/synthesis/synthesize.h"

#include "core/node.h"

namespace terrazzo {
namespace {
void compute(NodeContext& node) {
  SynthesisOptions options;
  options.size = node.size("size");
  options.seed = uint64_t(node.integer("seed"));
  const std::string& tileable = node.text("tileable");
  options.tile_x = tileable == "x" || tileable == "xy";
  options.tile_y = tileable == "y" || tileable == "xy";
  options.coherence = node.number("coherence");
  options.evenness = node.number("evenness");
  options.jitter = node.numbers("jitter");
  node.output("uv", synthesize(*node.input<Index>("index"), options, node.task()));
}
}  // namespace

NodeType synthesize_node() {
  NodeType t;
  t.name = "synthesize";
  t.version = 2;
  t.category = "synthesis";
  t.summary = "Makes a uv map of any size from an index";
  t.help =
      "Decides for every output pixel which exemplar pixel it shows, coarse to fine, so that every neighbourhood of "
      "the "
      "result looks like one of the exemplar (appearance-space synthesis, Lefebvre & Hoppe 2006). The same index, size "
      "and "
      "seed give the same uv map on every machine. resolve_uv turns the uv map into maps.";
  t.inputs = {{.name = "index", .type = ValueType::index, .help = "the analysed exemplar"}};
  t.outputs = {{.name = "uv", .type = ValueType::uv_map, .help = "the exemplar pixel of every output pixel"}};
  t.params = {
      {.name = "size",
       .type = ParamType::size,
       .fallback = Size{1024, 1024},
       .help = "Size of the result.",
       .min = 1,
       .max = 32768,
       .unit = "pixels"},
      {.name = "seed",
       .type = ParamType::integer,
       .fallback = 1,
       .help = "Another seed gives another arrangement.",
       .min = 0},
      {.name = "tileable",
       .type = ParamType::choice,
       .fallback = "none",
       .help = "Directions in which the result wraps around without a seam.",
       .choices = {"none", "x", "y", "xy"}},
      {.name = "coherence",
       .type = ParamType::number,
       .fallback = 0.55,
       .help = "Factor on the cost of continuing a neighbouring piece of the exemplar. Smaller values copy larger "
               "pieces: more faithful, less varied.",
       .min = 0.05,
       .max = 1},
      {.name = "evenness",
       .type = ParamType::number,
       .fallback = 0.7,
       .help = "How strongly over-used parts of the exemplar are avoided. 0 lets the best-fitting parts repeat.",
       .min = 0,
       .max = 10},
      {.name = "jitter",
       .type = ParamType::numbers,
       .fallback = Numbers{},
       .help = "Random displacement per level, coarsest level first; levels not listed have none. More jitter, more "
               "variety, less structure.",
       .min = 0,
       .max = 1024,
       .unit = "exemplar pixels of the level"},
  };
  t.compute = compute;
  t.memory_hint = [](const NodeContext& node) { return size_t(node.size("size").area()) * 3 * sizeof(ExemplarPixel); };
  return t;
}

}  // namespace terrazzo
