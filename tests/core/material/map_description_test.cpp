#include "core/material/map_description.h"

#include <doctest/doctest.h>

#include "core/material/material_files.h"

using namespace terrazzo;

TEST_CASE("a line of the description says the map, its green channel, its colour space and its size") {
  const auto normal =
      file_description("made with care\nterrazzo: normal green=down color_space=raw metres=2x1.5 shine=1\nmore");
  REQUIRE(normal);
  REQUIRE(normal->maps.size() == 1);
  CHECK(normal->maps[0].semantic == Semantic::normal);
  CHECK(normal->maps[0].channels.empty());
  CHECK(normal->normal_y == NormalY::down);
  CHECK(normal->color_space == "raw");
  CHECK(normal->metres == PhysicalSize{2, 1.5});
  CHECK(file_description("terrazzo: normal green=up")->normal_y == NormalY::up);
  CHECK_FALSE(file_description("terrazzo: height")->normal_y);
  for (const char* other : {"", "terrazzo: bumpiness", "uv map into an exemplar", "terrazzo:", "a terrazzo: height"})
    CHECK_FALSE(file_description(other));
  for (const char* no_size : {"2", "2x", "x2", "2x-1", "0x1", "2x1m", "1e9x1", "nanx1"})
    CHECK_FALSE(file_description(std::string("terrazzo: height metres=") + no_size)->metres.is_known());
}

TEST_CASE("a description says which channels of a packed file hold which maps") {
  const auto packed = file_description("terrazzo: metallic=r mask_detail=b roughness=1-a height=red color_space=raw");
  REQUIRE(packed);
  REQUIRE(packed->maps.size() == 3);
  CHECK(packed->maps[1].name == "mask_detail");
  CHECK(packed->maps[1].semantic == Semantic::mask);
  CHECK(packed->maps[2].channels == "a");
  CHECK(packed->maps[2].inverted);
  CHECK_FALSE(packed->maps[0].inverted);
  CHECK(description_line(*packed) == "terrazzo: metallic=r mask_detail=b roughness=1-a color_space=raw");
  ImageInfo info;
  info.semantic = Semantic::normal;
  info.normal_y = NormalY::down;
  CHECK(description_line(description_of("normal", info, {2, 0.25})) ==
        "terrazzo: normal green=down color_space=raw metres=2x0.25");
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
  CHECK(maps_of("wall_cavity.png", "terrazzo: data").front().map == "data_cavity");
  CHECK(maps_of("wall_ao.png", "terrazzo: mask_moss").front().map == "mask_moss");
  CHECK(maps_of("wall_color.exr", "terrazzo: base_color color_space=acescg").front().color_space == "acescg");
}

TEST_CASE("a packed file is known by its description whatever its name is") {
  const auto maps_of = [](const char* name, int channels) {
    return recognise_map({.name = name,
                          .size = {},
                          .channels = channels,
                          .description = "terrazzo: ambient_occlusion=r roughness=1-g color_space=raw"});
  };
  for (const char* name : {"final.png", "wall_ORM.png", "wall_height.png"}) {
    const auto maps = maps_of(name, 3);
    REQUIRE(maps.size() == 2);
    CHECK(maps[0].map == "ambient_occlusion");
    CHECK(maps[0].channels == "r");
    CHECK(maps[1].inverted);
  }
  CHECK(maps_of("wall_height.png", 1).front().map == "height");  // the channels were dropped, the text was kept
}
