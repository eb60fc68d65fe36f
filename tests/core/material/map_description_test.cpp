#include "core/material/map_description.h"

#include <doctest/doctest.h>

#include "core/material/material_files.h"

using namespace terrazzo;

TEST_CASE("a line of the description says the map, its green channel and its colour space") {
  const auto normal = described_map("made with care\nterrazzo: normal green=down color_space=raw shine=1\nmore");
  REQUIRE(normal);
  CHECK(normal->semantic == Semantic::normal);
  CHECK(normal->normal_y == NormalY::down);
  CHECK(normal->color_space == "raw");
  CHECK(described_map("terrazzo: normal green=up")->normal_y == NormalY::up);
  CHECK_FALSE(described_map("terrazzo: height")->normal_y);
  for (const char* other : {"", "terrazzo: bumpiness", "uv map into an exemplar", "terrazzo:", "a terrazzo: height"})
    CHECK_FALSE(described_map(other));
}

TEST_CASE("a description counts more than the name of a file that holds one map") {
  const auto maps_of = [](const char* name, const char* description) {
    return recognise_map({.name = name, .size = {}, .description = description});
  };
  const auto gl = maps_of("wall_nor_dx.png", "terrazzo: normal green=up");
  REQUIRE(gl.size() == 1);
  CHECK(gl.front().normal_y == NormalY::up);
  CHECK(gl.front().said_by == "its description");
  CHECK(maps_of("result.png", "terrazzo: roughness").front().map == "roughness");
  CHECK(maps_of("wall_color.png", "terrazzo: emission").front().map == "emission");
  CHECK(maps_of("mask_moss.png", "terrazzo: mask").front().map == "mask_moss");
  CHECK(maps_of("data_fuzz.png", "terrazzo: data").front().map == "data_fuzz");
  CHECK(maps_of("wall_ORM.png", "terrazzo: data").size() == 3);
  CHECK(maps_of("wall_color.exr", "terrazzo: base_color color_space=acescg").front().color_space == "acescg");
}
