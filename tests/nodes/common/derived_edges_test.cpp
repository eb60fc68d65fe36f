#include "nodes/common/derived_edges.h"

#include <doctest/doctest.h>

#include "tests/nodes/image/image_checks.h"

using namespace terrazzo;
using namespace terrazzo::test;

namespace {

/// Soft bumps that repeat after `period` pixels; what is cut out of a longer period does not tile.
ImagePtr bumps(Size size, int period, Semantic semantic = Semantic::height, int channels = 1) {
  return make_image(
      size, channels,
      [period](int x, int y, int c) {
        float sum = 0;
        for (int dy = 0; dy < 5; dy++)
          for (int dx = 0; dx < 5; dx++)
            sum += float(unit_double(random_bits(7 + c, (x + dx) % period, (y + dy) % period))) / 25;
        return sum;
      },
      semantic);
}

struct Deriving {
  const char* node;
  const char* in;
  const char* out;
  Semantic of = Semantic::height;
  Params params{};
};

ImagePtr derived(const Deriving& d, const ImagePtr& image, const std::string& edges, bool* said = nullptr) {
  Params params = d.params;
  if (!edges.empty()) params["edges"] = edges;
  const NodeRun run = run_node(d.node, params, {{d.in, {image}}});
  if (said) *said = run.says("the input tiles");
  const Value& out = run.outputs.at(d.out);
  const MaterialPtr* material = std::get_if<MaterialPtr>(&out);
  return material ? (*material)->maps().front().image : std::get<ImagePtr>(out);
}

const std::vector<Deriving> all_deriving = {
    {"blur", "image", "image", Semantic::height, {{"radius", 3.0}}},
    {"make_normal", "height", "normal"},
    {"make_occlusion", "height", "occlusion", Semantic::height, {{"radius", int64_t{5}}}},
    {"make_bent_normal", "height", "normal", Semantic::height, {{"radius", int64_t{5}}}},
    {"make_curvature", "image", "curvature"},
    {"make_height", "normal", "height", Semantic::normal},
    {"resize", "material", "material", Semantic::height, {{"scale", 0.7}}},
};

}  // namespace

TEST_CASE("what is derived from a map that tiles tiles, and says so; an explicit choice wins") {
  const Size size{96, 96};
  for (const Deriving& d : all_deriving) {
    CAPTURE(d.node);
    const bool normals = d.of == Semantic::normal;
    const ImagePtr image = normals ? derived(all_deriving[1], bumps(size, 96), "wrap") : bumps(size, 96);
    bool said = false, said_clamp = true;
    CHECK(derived(d, image, "", &said)->pixels() == derived(d, image, "wrap")->pixels());
    CHECK(said);
    CHECK(derived(d, image, "clamp", &said_clamp)->pixels() != derived(d, image, "wrap")->pixels());
    CHECK_FALSE(said_clamp);
  }
}

TEST_CASE("what is derived from a map that does not tile ends at its borders, without a word") {
  const Size size{96, 96};
  for (const Deriving& d : all_deriving) {
    CAPTURE(d.node);
    const bool normals = d.of == Semantic::normal;
    const ImagePtr image = normals ? derived(all_deriving[1], bumps(size, 1000), "clamp") : bumps(size, 1000);
    bool said = true;
    CHECK(derived(d, image, "", &said)->pixels() == derived(d, image, "clamp")->pixels());
    CHECK_FALSE(said);
  }
}

TEST_CASE("large maps are compared at a smaller size, and tell the same") {
  const Size large{1100, 1300};
  const auto said = [&](int period) {
    bool out = false;
    // A period for each side: 100 divides both.
    derived(all_deriving[0], bumps(large, period), "", &out);
    return out;
  };
  CHECK(said(100));
  CHECK_FALSE(said(997));
}

TEST_CASE("what does not look around needs no edges") {
  bool said = true;
  derived({"blur", "image", "image", Semantic::height, {{"radius", 0.0}}}, bumps({96, 96}, 96), "", &said);
  CHECK_FALSE(said);
  derived({"resize", "material", "material", Semantic::height, {{"scale", 2.0}, {"filter", "nearest"}}},
          bumps({96, 96}, 96), "", &said);
  CHECK_FALSE(said);
}
