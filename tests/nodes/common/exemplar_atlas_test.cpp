#include "nodes/common/exemplar_atlas.h"

#include <doctest/doctest.h>

#include "core/base/error.h"
#include "nodes/common/registry.h"
#include "nodes/common/shape_rules.h"
#include "tests/run_node.h"
#include "tests/texts.h"

using namespace terrazzo;
using namespace terrazzo::test;

namespace {

MaterialPtr material(Size size, int divisor = 1) {
  const auto zero = [](int, int, int) { return 0.25f; };
  return Material::make(
      "m", {{"base_color", make_image(size, 3, zero, Semantic::base_color)},
            {"height", make_image({size.width / divisor, size.height / divisor}, 1, zero, Semantic::height)}});
}

OutputForecasts foreseen(const char* name, const InputForecasts& inputs, const Params& given = {}) {
  const NodeType& type = *find_node_type(name);
  Params params = given;
  for (const Param& p : type.params)
    if (p.fallback) params.emplace(p.name, *p.fallback);
  return type.infer(params, inputs);
}

/// What is foreseen of materials that are there is what comes out.
void check_foreseen(const char* name, const char* port, const std::vector<MaterialPtr>& materials,
                    const Params& params = {}) {
  InputForecasts known;
  std::map<std::string, std::vector<Value>> inputs;
  for (const MaterialPtr& m : materials) {
    known[port].push_back(forecast_of(m));
    inputs[port].push_back(m);
  }
  const OutputForecasts out = foreseen(name, known, params);
  const NodeRun run = run_node(name, params, inputs);
  for (const char* output : {"material", "mask", "labels"})
    CHECK(contradiction(out.at(output), run.outputs.at(output)) == "");
  const MaterialPtr made = run.get<Material>("material");
  CHECK(material_size(out.at("material")) == made->size());
  CHECK(map_of(out.at("material"), "height").size == made->find("height")->size());
  CHECK(out.at("mask").images.at("").size == made->size());
  CHECK(out.at("labels").images.at("").size == made->size());
}

}  // namespace

TEST_CASE("the sizes of what lies side by side are foreseen") {
  check_foreseen("combine", "materials", {material({24, 16}), material({10, 32})}, {{"gap", int64_t{5}}});
  check_foreseen("combine", "materials", {material({24, 16}, 2), material({12, 32}, 4), material({8, 8}, 2)});
  check_foreseen("variants", "material", {material({24, 16})});
  check_foreseen("variants", "material", {material({24, 16}, 4)},
                 {{"rotations", Numbers{30, 90}}, {"scales", Numbers{0.7, 1.5}}, {"mirror", "xy"}});
}

TEST_CASE("maps that there may be: the size is known unless they decide it") {
  Forecast f = forecast_of(material({32, 16}));
  const auto size_with = [&](std::optional<Size> opacity) {
    Forecast with = f;
    with.possible_maps = std::vector<std::string>{"opacity"};
    with.images["opacity"] = {.size = opacity};
    return foreseen("combine", {{"materials", {with, with}}}, {{"gap", int64_t{3}}}).at("mask").images.at("").size;
  };
  CHECK(size_with(Size{32, 16}) == Size{32, 35});
  CHECK_FALSE(size_with(Size{8, 4}).has_value());  // the gap would be 4
  CHECK_FALSE(size_with(std::nullopt).has_value());
  f.possible_maps.reset();
  CHECK_FALSE(foreseen("combine", {{"materials", {f, f}}}).at("mask").images.at("").size.has_value());
}

TEST_CASE("an atlas that is too large is found before it is made") {
  const Forecast large{.maps = {"height"},
                       .possible_maps = std::vector<std::string>{},
                       .images = {{"height", {.size = Size{30000, 60000}}}}};
  CHECK_THROWS_WITH_AS(foreseen("combine", {{"materials", {large, large, large, large, large}}}),
                       doctest::Contains("more than 65536 a side"), Error);
}
