#include "runner/report/torn_pictures.h"

#include <doctest/doctest.h>

#include "nodes/common/registry.h"
#include "tests/drawn_stones.h"

using namespace terrazzo;
using namespace terrazzo::test;

namespace {

constexpr Size side{240, 240};

/// A run of `synthesize` whose uv map shifts each square of `cell` pixels on its own; 0: not at all.
struct Laid {
  Graph graph;
  RunResult result;

  explicit Laid(int cell) {
    const DrawnStones stones(side);
    const FeaturesPtr features =
        plain_features(stones.image(), true)->with(std::make_shared<const Elements>(stones.elements()));
    GraphNode first, layout;
    first.name = "index";
    first.type = find_node_type("index");
    graph.nodes.push_back(first);
    layout.name = "layout";
    layout.type = find_node_type("synthesize");
    layout.inputs["index"] = {Wire{"index", "index"}};
    graph.nodes.push_back(layout);
    std::vector<ExemplarPixel> pixels;
    for (int y = 0; y < side.height; y++)
      for (int x = 0; x < side.width; x++) {
        const int move = cell > 0 ? (x / cell * 37 + y / cell * 71) % 97 : 0;
        pixels.push_back({uint16_t((x + move) % side.width), uint16_t((y + 2 * move) % side.height)});
      }
    result.kept["layout"]["uv"] = UvMap::make(side, side, std::move(pixels), {true, true, true});
    result.kept["index"]["index"] = make_index(make_appearance(*features, {}, {}, Task()), 3, Task());
  }
  std::vector<TornPicture> pictures(const std::vector<ShownMaterial>& materials = {}) const {
    return torn_pictures(graph, result, materials, Task());
  }
};

}  // namespace

TEST_CASE("a report shows which elements are torn, and nothing where they are whole") {
  CHECK(Laid(0).pictures().empty());
  Laid torn(30);
  REQUIRE(torn.pictures().size() == 1);
  CHECK(torn.pictures()[0].node == "layout");
  CHECK(torn.pictures()[0].picture->info().semantic == Semantic::mask);

  ImageInfo info{.size = side, .channels = 3, .semantic = Semantic::base_color};
  const ImagePtr white = Image::from_floats(info, std::vector<float>(size_t(side.area()) * 3, 1.0f));
  const std::vector<TornPicture> lit = torn.pictures({{"result", Material::of(white)}});
  REQUIRE(lit.size() == 1);
  int64_t bright = 0, dim = 0;
  for (const float v : lit[0].picture->pixels()) (v > 0.9f ? bright : dim)++;
  CHECK(bright > side.area());  // most of it, in three channels
  CHECK(dim > side.area() / 10);

  torn.result.kept.erase("index");
  CHECK(torn.pictures().empty());
}
