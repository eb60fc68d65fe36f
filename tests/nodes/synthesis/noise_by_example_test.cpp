#include <algorithm>
#include <cmath>

#include <doctest/doctest.h>

#include "core/base/error.h"
#include "core/base/hash.h"
#include "nodes/common/registry.h"
#include "tests/run_node.h"

using namespace terrazzo;
using namespace terrazzo::test;

namespace {

/// Soft random heights, and colours that follow them, which tile.
MaterialPtr soil(Size size) {
  const auto height = [size](int x, int y) {
    double sum = 0;
    for (int dy = -1; dy <= 1; dy++)
      for (int dx = -1; dx <= 1; dx++)
        sum += unit_double(random_bits(3, (x + dx + size.width) % size.width, (y + dy + size.height) % size.height));
    return float(sum / 9);
  };
  const ImagePtr heights = make_image(
      size, 1, [&](int x, int y, int) { return height(x, y); }, Semantic::height);
  const ImagePtr colours = make_image(
      size, 3, [&](int x, int y, int c) { return height(x, y) * float(c); }, Semantic::base_color, "srgb_texture");
  return Material::make("soil", {{"height", heights}, {"base_color", colours}}, {1, 1});
}

NodeRun run(const MaterialPtr& material, const Params& params) {
  return run_node("noise_by_example", params, {{"material", {material}}});
}

std::vector<float> heights(const MaterialPtr& material, const Params& params) {
  return run(material, params).get<Material>("material")->find("height")->pixels();
}

Params filled(Params params) {
  for (const Param& p : find_node_type("noise_by_example")->params)
    if (p.fallback) params.emplace(p.name, *p.fallback);
  return params;
}

}  // namespace

TEST_CASE("what is foreseen of noise by example is what comes out") {
  const MaterialPtr material = soil({64, 64});
  const Params params = filled({{"size", Size{70, 30}}});
  const NodeType& type = *find_node_type("noise_by_example");
  const InputForecasts inputs{{"material", {forecast_of(material)}}};
  const OutputForecasts foreseen = type.infer(params, inputs);
  const MaterialPtr made = run(material, params).get<Material>("material");
  CHECK(contradiction(foreseen.at("material"), made) == "");
  CHECK(made->map_names() == material->map_names());
  CHECK(made->size() == Size{70, 30});
  CHECK(made->metres().width == doctest::Approx(70.0 / 64));
  // Four channels and one that is sorted, at each pixel of the exemplar.
  CHECK(type.memory_ahead(params, inputs) == 64 * 64 * 5 * sizeof(float));
  CHECK(type.memory_ahead(params, {{"material", {{}}}}) == 0);
}

TEST_CASE("the node's surface wraps after its own size or one that is given, and origin shows any part of it") {
  const MaterialPtr material = soil({64, 64});
  const Params whole{{"size", Size{90, 50}}, {"tileable", "xy"}, {"tiles", "no"}};
  const std::vector<float> all = heights(material, whole);
  Params part = whole;
  part["size"] = Size{40, 20};
  part["surface"] = Size{90, 50};
  part["origin"] = Numbers{80 - 900, 45 + 500};
  const std::vector<float> found = heights(material, part);
  for (int y = 0; y < 20; y++)
    for (int x = 0; x < 40; x++) REQUIRE(found[y * 40 + x] == all[(45 + y) % 50 * 90 + (80 + x) % 90]);
  Params x_only = whole, y_only = whole;
  x_only["tileable"] = "x";
  y_only["tileable"] = "y";
  CHECK(heights(material, x_only) != all);
  CHECK(heights(material, y_only) != heights(material, x_only));
}

TEST_CASE("whether the exemplar tiles is found out, and told") {
  const std::string told = "the exemplar tiles";
  CHECK(run(soil({64, 64}), {{"size", Size{8, 8}}}).says(told));
  CHECK(!run(soil({64, 64}), {{"size", Size{8, 8}}, {"tiles", "no"}}).says(told));
  CHECK(heights(soil({64, 64}), {{"size", Size{60, 60}}, {"tiles", "yes"}}) !=
        heights(soil({64, 64}), {{"size", Size{60, 60}}, {"tiles", "no"}}));
}

TEST_CASE("a cell is a share of the exemplar or pixels; one that does not fit is made smaller with a warning") {
  const MaterialPtr material = soil({64, 80});
  const Params size{{"size", Size{60, 60}}, {"tiles", "no"}};
  const auto with = [&](double cell) {
    Params p = size;
    p["cell"] = cell;
    return p;
  };
  CHECK(heights(material, with(0.25)) == heights(material, with(16)));
  CHECK(heights(material, with(0.25)) != heights(material, with(12)));
  CHECK(run(material, with(31)).notes.empty());
  const NodeRun large = run(material, with(40));
  REQUIRE(large.notes.size() == 1);
  CHECK(
      large.notes[0] ==
      "warning: \"cell\": samples of 40 pixels do not fit into an exemplar of 64x80 that does not tile; 31 pixels are "
      "used");
  CHECK(large.get<Material>("material")->find("height")->pixels() == heights(material, with(31)));
}

TEST_CASE("an origin between pixels is a problem of the document, and maps of two shapes are one of the input") {
  const NodeType& type = *find_node_type("noise_by_example");
  CHECK(type.check(filled({{"origin", Numbers{-7, 1e9}}})).empty());
  CHECK(type.check(filled({{"origin", Numbers{0.5, 0}}})).at(0).starts_with("\"origin\""));
  const MaterialPtr odd = Material::make(
      "odd", {{"height", soil({64, 64})->find("height")}, {"roughness", soil({64, 32})->find("height")}});
  CHECK(error_of("noise_by_example", {}, {{"material", {odd}}}).starts_with("material: "));
}

TEST_CASE("exemplars too small to look for borders in work") {
  for (const Size size : {Size{1, 1}, Size{3, 2}, Size{8, 8}}) {
    const NodeRun made = run(soil(size), {{"size", Size{20, 20}}});
    CHECK(made.get<Material>("material")->find("height")->pixels().size() == 400);
  }
}
