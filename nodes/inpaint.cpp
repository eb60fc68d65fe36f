#include <algorithm>

#include "core/error.h"
#include "core/image_ops.h"
#include "core/synthesis/kept.h"
#include "nodes/synthesis_params.h"

namespace terrazzo {

namespace {

/// What is there: the pixels of `uv`, or the exemplar itself, outside the holes.
KeptPixels outside_holes(const UvMap* uv, const ImagePtr& holes, Size size) {
  KeptPixels kept;
  kept.keep.reserve(size_t(size.area()));
  kept.pixels.reserve(size_t(size.area()));
  for_each_strip(*nearest_at_size(holes, size), [&](const Rect& r, const float* v) {
    for (int64_t i = 0; i < r.area(); i++) kept.keep.push_back(!(v[i * holes->channels()] > 0.5f));
  });
  if (uv) {
    kept.pixels = uv->pixels();
    return kept;
  }
  for (int y = 0; y < size.height; y++)
    for (int x = 0; x < size.width; x++) kept.pixels.push_back({uint16_t(x), uint16_t(y)});
  return kept;
}

void compute(NodeContext& node) {
  const auto index = node.input<Index>("index");
  const auto uv = node.optional_input<UvMap>("uv");
  const auto holes = node.input<Image>("mask");
  SynthesisOptions options = synthesis_options(node, *index);
  if (uv) {
    require_same_exemplar(*uv, *index);
    options.size = uv->size();
    options.tile_x |= uv->wraps().x;
    options.tile_y |= uv->wraps().y;
  }
  require_shape("mask", *holes, uv ? "the uv map" : "the exemplar", options.size);
  options.kept = outside_holes(uv.get(), holes, options.size);
  const std::vector<uint8_t>& keep = options.kept.keep;
  if (std::find(keep.begin(), keep.end(), 1) == keep.end())
    throw Error("mask",
                "the holes cover everything, so that nothing is kept; white (above 0.5) is filled and black stays. "
                "Invert the mask (levels) if it is the other way round; for wholly new material use \"synthesize\"");
  node.output("uv", synthesize(*index, options, node.task()));
}

}  // namespace

NodeType inpaint_node() {
  NodeType t;
  t.name = "inpaint";
  t.version = 11;
  t.category = "synthesis";
  t.summary = "Fills holes and keeps the rest pixel by pixel";
  t.help =
      "Every map is filled at once, through one uv map: pixels outside the holes stay exactly as they are, those "
      "inside continue them with material from elsewhere in the exemplar. Without \"uv\" the exemplar itself is what "
      "is there; give weight the inverted mask then, so that nothing is taken out of the holes. With \"uv\" parts of "
      "an earlier result are made anew, and it wraps as before. Where resolve_uv joins heights, those outside the "
      "holes "
      "stay if it is given what is there as `kept` and the mask as `holes`.";
  t.inputs = {index_port(),
              {.name = "mask",
               .type = ValueType::image,
               .help = "the holes: above 0.5 (white) is filled, the rest stays. Of the shape of what is there, at any "
                       "size; if it has several channels, the first counts"},
              {.name = "uv",
               .type = ValueType::uv_map,
               .help = "what is there; if not given, the exemplar as it is",
               .optional = true}};
  t.outputs = {uv_output()};
  t.params = with_synthesis_params({tileable_param()});
  t.check = check_synthesis_params;
  t.compute = compute;
  t.memory_hint = [](const NodeContext& node) {
    const auto uv = node.optional_input<UvMap>("uv");
    return 3 * synthesis_memory(uv ? uv->size() : node.input<Index>("index")->appearance()->size());
  };
  return t;
}

}  // namespace terrazzo
