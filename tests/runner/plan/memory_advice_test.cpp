#include "runner/plan/memory_advice.h"

#include <doctest/doctest.h>

#include "tests/texts.h"

using namespace terrazzo;
using namespace terrazzo::test;

namespace {

constexpr uint64_t mib = 1 << 20;

/// A node that takes so many bytes for each pixel that comes into "in", and others whatever comes.
NodeType taking(ValueType in, uint64_t per_pixel, uint64_t fixed) {
  NodeType type;
  type.inputs = {{.name = "in", .type = in}, {.name = "uv", .type = ValueType::uv_map}};
  type.memory_ahead = [=](const Params&, const InputForecasts& inputs) {
    const Forecast& f = inputs.at("in").front();
    const Size size = f.size ? *f.size : f.images.begin()->second.size.value();
    return uint64_t(size.area()) * per_pixel + fixed;
  };
  return type;
}

std::string advice(const NodeType& type, const InputForecasts& inputs, uint64_t budget) {
  return memory_advice(type, {}, inputs, type.memory_ahead({}, inputs), budget);
}

}  // namespace

TEST_CASE("a budget that is too small: how much would do, or which exemplar") {
  const NodeType type = taking(ValueType::index, 100, 0);
  CHECK(advice(type, {{"in", {{.size = Size{2048, 1024}}}}}, 50 * mib) ==
        "it takes about 200 MiB for an exemplar of 2048x1024, and --memory gives 50 MiB. Give --memory 200M, or scale "
        "the exemplar to 1024x512 first, as the node type \"resize\" does");
}

TEST_CASE("a smaller exemplar is advised only if it would do") {
  const InputForecasts inputs{{"in", {{.size = Size{1024, 1024}}}}};
  CHECK(advice(taking(ValueType::index, 1, 300 * mib), inputs, 50 * mib) ==
        "it takes about 301 MiB, and --memory gives 50 MiB. Give --memory 301M, or make a smaller result");
  const NodeType mixed = taking(ValueType::index, 80, 20 * mib);
  const std::string text = advice(mixed, inputs, 50 * mib);
  const size_t at = text.find("scale the exemplar to ");
  REQUIRE(at != text.npos);
  const int side = std::stoi(text.substr(at + 22));
  CHECK(mixed.memory_ahead({}, {{"in", {{.size = Size{side, side}}}}}) <= 50 * mib);
  CHECK(side > 500);
}

TEST_CASE("images are called so, and uv maps are no exemplars") {
  Forecast image;
  image.images[""] = {.size = Size{2048, 2048}};
  CHECK(contains(advice(taking(ValueType::image, 4, 0), {{"in", {image}}}, 4 * mib),
                 "for an image of 2048x2048, and --memory gives 4 MiB. Give --memory 16M, or scale the image to "
                 "1024x1024"));
  const InputForecasts with_uv{{"in", {{.size = Size{64, 64}}}}, {"uv", {{.size = Size{4096, 4096}}}}};
  CHECK(contains(advice(taking(ValueType::index, 1024, 0), with_uv, mib), "for an exemplar of 64x64"));
}
