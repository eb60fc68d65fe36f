#include "nodes/common/synthesis/synthesis_memory.h"

#include <doctest/doctest.h>

#include "nodes/common/registry.h"

using namespace terrazzo;

namespace {

constexpr Size exemplar{512, 256};
constexpr uint64_t pixels = 512 * 256, mib = 1 << 20;

uint64_t ahead(const char* name, const InputForecasts& inputs, const Params& given = {}) {
  const NodeType& type = *find_node_type(name);
  Params params = given;
  for (const Param& p : type.params)
    if (p.fallback) params.emplace(p.name, *p.fallback);
  return type.memory_ahead(params, inputs);
}

InputForecasts index_and(InputForecasts others = {}) {
  others["index"] = {{.size = exemplar}};
  return others;
}

Forecast image(Size size, int channels = 1, Semantic semantic = Semantic::data) {
  Forecast f;
  f.images[""] = {.size = size, .channels = channels, .semantic = semantic};
  return f;
}

const Params large{{"size", Size{1024, 1024}}};
constexpr uint64_t held = 48 * pixels + 16 * mib;  // index and program

}  // namespace

TEST_CASE("what synthesis takes follows from the exemplar's size and the result's") {
  CHECK(ahead("synthesize", index_and(), large) == held + 6 * mib);
  CHECK(ahead("extend", index_and(), large) == held + 26 * mib);
  CHECK(ahead("make_tileable", index_and()) == held + 22 * pixels);
  CHECK(ahead("inpaint", index_and()) == held + 22 * pixels);
  CHECK(ahead("inpaint", index_and({{"uv", {{.size = Size{1024, 1024}}}}})) == held + 35 * mib);
  CHECK(ahead("synthesize_coarse", index_and(), large) == 48 * pixels + 6 * mib);
}

TEST_CASE("a part of a surface takes the coarse levels of all of it, unless they come by a wire") {
  Params part = large;
  part["surface"] = Size{4096, 4096};
  const uint64_t alone = ahead("synthesize", index_and(), part);
  CHECK(alone == held + 6 * mib + 6 * 16 * mib);
  CHECK(ahead("synthesize", index_and({{"coarse", {{}}}}), part) == held + 6 * mib);
}

TEST_CASE("controls take memory by their channels, and labels for the distances to them") {
  const InputForecasts inputs = index_and({{"target", {image({64, 64}, 3), image({64, 64})}}});
  CHECK(ahead("transfer", inputs, large) == held + (6 + 2 * 4) * mib);
  Params labels = large;
  labels["leeway"] = 4.0;
  CHECK(ahead("transfer", inputs, labels) == held + (6 + 2 * 4 + 21) * mib);
}

TEST_CASE("of what is not known nothing is said") {
  for (const char* name : {"synthesize", "extend", "make_tileable", "inpaint", "transfer", "synthesize_coarse"})
    CHECK(ahead(name, {{"index", {{}}}}) == 0);
  CHECK(ahead("inpaint", index_and({{"uv", {{}}}})) == 0);
  CHECK(ahead("resolve_uv", {{"uv", {{}}}, {"material", {{}}}}) == 0);
  CHECK(ahead("make_occlusion", {{"height", {{}}}}) == 0);
}

TEST_CASE("resolve_uv holds the exemplar's maps and the uv map; more to blend and to join") {
  Forecast material{.maps = {"base_color", "height", "mask"}, .possible_maps = std::vector<std::string>{}};
  material.images = {{"base_color", {.size = exemplar, .channels = 3, .semantic = Semantic::base_color}},
                     {"height", {.size = exemplar, .channels = 1, .semantic = Semantic::height}},
                     {"mask", {.size = exemplar, .channels = 1, .semantic = Semantic::mask}}};
  const InputForecasts inputs{{"uv", {{.size = Size{1024, 1024}, .exemplar = exemplar}}}, {"material", {material}}};
  const uint64_t plain = ahead("resolve_uv", inputs);
  CHECK(plain == 4 * mib + 4 * 5 * pixels);
  CHECK(ahead("resolve_uv", inputs, {{"blend", 3.0}}) == 4 * mib + 4 * (3 * 4 + 1) * pixels);
  CHECK(ahead("resolve_uv", inputs, {{"join", 8.0}}) == plain + uint64_t(8.0 / 3 * double(mib)));
}

TEST_CASE("resolve_uv holds the exemplar's maps, whatever the size of the uv map") {
  Forecast material{.maps = {"base_color", "height"}, .possible_maps = std::vector<std::string>{}};
  material.images = {{"base_color", {.size = exemplar, .channels = 3, .semantic = Semantic::base_color}},
                     {"height", {.size = exemplar, .channels = 1, .semantic = Semantic::height}}};
  const NodeType& tileable = *find_node_type("make_tileable");
  Params params;
  for (const Param& p : tileable.params)
    if (p.fallback) params.emplace(p.name, *p.fallback);
  params["fit"] = std::string("repeats");
  const Forecast uv = tileable.infer(params, index_and()).at("uv");
  REQUIRE_FALSE(uv.size);
  CHECK(ahead("resolve_uv", {{"uv", {uv}}, {"material", {material}}}) == 4 * 4 * pixels);
  CHECK(ahead("resolve_uv", {{"uv", {uv}}, {"material", {{}}}}) == 0);
}

TEST_CASE("occlusion and bent normals are held as a whole") {
  CHECK(ahead("make_occlusion", {{"height", {image({1024, 1024})}}}) == 4 * mib);
  CHECK(ahead("make_bent_normal", {{"height", {image({1024, 1024})}}}) == 12 * mib);
}
