#include <algorithm>
#include <numeric>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/image/image_facts.h"
#include "nodes/common/node_helpers.h"
#include "nodes/common/shape_rules.h"

namespace terrazzo {

namespace {

/// The rectangle in pixels of the material's size.
Rect asked_rect(const Params& params, Size material) {
  const int x = int(std::get<int64_t>(params.at("x"))), y = int(std::get<int64_t>(params.at("y")));
  const Size size = std::get<Size>(params.at("size"));
  const Rect rect{x, y, size.width ? size.width : material.width - x, size.height ? size.height : material.height - y};
  if (rect.empty())
    throw Error("size", fmt::format("nothing is left of a material of {} from x {}, y {}", describe(material), x, y));
  if (std::get<std::string>(params.at("edges")) == "none" && intersect(rect, whole(material)) != rect)
    throw Error("size", fmt::format("expected a rectangle inside the material of {}, found {} at x {}, y {}; set "
                                    "\"edges\" to clamp or wrap to reach beyond its border",
                                    describe(material), describe({rect.width, rect.height}), x, y));
  return rect;
}

/// A length in pixels of the material, in pixels of one of its maps.
int in_map(int length, int map_side, int material_side, const std::string& map, Size size, Size material) {
  const int64_t product = int64_t{length} * map_side;
  if (product % material_side == 0) return int(product / material_side);
  throw Error("size",
              fmt::format("the rectangle does not fall on whole pixels of map \"{}\", which has {} where the material "
                          "has {}; use multiples of {} pixels, or put \"resize\" before it",
                          map, describe(size), describe(material), material_side / std::gcd(material_side, map_side)));
}

/// The rectangle in pixels of a map.
Rect rect_in_map(const Rect& rect, const std::string& map, Size size, Size material) {
  return {in_map(rect.x, size.width, material.width, map, size, material),
          in_map(rect.y, size.height, material.height, map, size, material),
          in_map(rect.width, size.width, material.width, map, size, material),
          in_map(rect.height, size.height, material.height, map, size, material)};
}

ImagePtr cropped(const NodeContext& node, const Map& map, const Rect& rect, Size material) {
  const Size size = map.image->size();
  const Rect own = rect_in_map(rect, map.name, size, material);
  ImageInfo info = map.image->info();
  info.size = {own.width, own.height};
  const Outside outside = edges_of(node);
  const auto around = [=](const Rect& r) { return Rect{own.x + r.x, own.y + r.y, r.width, r.height}; };
  const auto reads = [=](size_t, const Rect& region) { return padded_parts(size, around(region), outside); };
  const auto copy = [=](std::span<const PixelView> in, const Rect& region, float* out) {
    const std::vector<float> pixels = read_padded(in[0], around(region), outside);
    std::copy(pixels.begin(), pixels.end(), out);
  };
  return Image::computed(info, map_recipe(node, *map.image), {.sources = {map.image}, .reads = reads, .compute = copy});
}

void compute_crop(NodeContext& node) {
  const MaterialPtr material = node.input<Material>("material");
  const Size size = material->size();
  const Rect rect = asked_rect(node.params(), size);
  const MaterialPtr part = with_maps_changed(material, {}, [&](const Map& m) { return cropped(node, m, rect, size); });
  const std::array share = {double(rect.width) / size.width, double(rect.height) / size.height};
  node.output("material", Material::make(part->name(), part->maps(), part->metres() * share));
}

OutputForecasts infer_crop(const Params& params, const InputForecasts& inputs) {
  const Forecast& material = inputs.at("material").front();
  const std::optional<Size> size = material_size(material);
  const std::optional<Rect> rect = size ? std::optional(asked_rect(params, *size)) : std::nullopt;
  return {{"material", with_facts_changed(material, [&](const std::string& map, ImageFacts& facts) {
             const bool is_known = rect && facts.size && certainly_has(material, map);
             const Rect own = is_known ? rect_in_map(*rect, map, *facts.size, *size) : Rect();
             facts.size = is_known ? std::optional(Size{own.width, own.height}) : std::nullopt;
           })}};
}

}  // namespace

NodeType crop_node() {
  NodeType t;
  t.name = "crop";
  t.category = "image";
  t.summary = "Cuts a rectangle out of a material";
  t.help =
      "Cuts the same part out of every map without changing pixels. The rectangle is in pixels of the largest map; it "
      "must fall on whole pixels of smaller ones, so that maps stay aligned. With edges set to wrap, a tileable "
      "material can be shifted or repeated.";
  t.inputs = {material_port("material", "the maps to cut; an image is taken as a material of one map")};
  t.outputs = {material_port("material", "the same part of every map")};
  Param edges = edges_param();
  edges.choices.insert(edges.choices.begin(), "none");
  edges.fallback = "none";
  edges.help =
      "What lies beyond the border: none makes that an error, clamp extends the border pixels, wrap repeats the maps.";
  t.params = {
      {.name = "x",
       .type = ParamType::integer,
       .fallback = int64_t{0},
       .help = "Left edge of the rectangle.",
       .min = -65536,
       .max = 65536,
       .unit = "pixels"},
      {.name = "y",
       .type = ParamType::integer,
       .fallback = int64_t{0},
       .help = "Top edge of the rectangle; y grows downwards.",
       .min = -65536,
       .max = 65536,
       .unit = "pixels"},
      {.name = "size",
       .type = ParamType::size,
       .fallback = Size{0, 0},
       .help = "Size of the rectangle; 0 reaches to the material's right or bottom edge.",
       .min = 0,
       .max = 65536,
       .unit = "pixels"},
      edges,
  };
  t.persist = Persist::derived;
  t.compute = compute_crop;
  t.infer = infer_crop;
  return t;
}

}  // namespace terrazzo
