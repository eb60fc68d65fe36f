#include "core/material/map_candidates.h"

#include <algorithm>

#include <doctest/doctest.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/material/material_files.h"

using namespace terrazzo;

namespace {

struct Layer {
  std::string name;
  int channels = 1;
};

Recognition recognised(const std::string& file, const std::vector<Layer>& layers) {
  std::vector<MapFile> files;
  for (const Layer& l : layers) files.push_back({.name = file, .size = {}, .channels = l.channels, .layer = l.name});
  return recognise_maps(files);
}

/// "roughness=Roughness metallic=Metallic": the maps of a file and their layers.
std::string maps_of(const std::string& file, const std::vector<Layer>& layers) {
  std::vector<std::string> out;
  for (const RecognisedMap& m : recognised(file, layers).maps)
    out.push_back(fmt::format("{}={}{}", m.map, m.layer, m.channels.empty() ? "" : ":" + m.channels));
  return fmt::format("{}", fmt::join(out, " "));
}

bool has_note(const Recognition& r, const std::string& part) {
  return std::ranges::any_of(r.notes, [&](const std::string& n) { return n.find(part) != std::string::npos; });
}

}  // namespace

TEST_CASE("a layer's name says which map it is, whatever the file's name says") {
  CHECK(maps_of("wall_arm.exr", {{"Metallic"}, {"AO"}, {"Roughness"}}) ==
        "roughness=Roughness metallic=Metallic ambient_occlusion=AO");
  CHECK(maps_of("wall.exr", {{"metallic"}, {"height"}, {"roughness"}}) ==
        "height=height roughness=roughness metallic=metallic");
  CHECK(maps_of("wall.exr", {{"albedo", 3}, {"roughness"}}) == "base_color=albedo roughness=roughness");
  CHECK(maps_of("wall_metallic.exr", {{"roughness", 3}}) == "roughness=roughness");
  CHECK(maps_of("set.exr", {{"ORM.AO"}, {"ORM.rough"}, {"ORM.met"}}) ==
        "roughness=ORM.rough metallic=ORM.met ambient_occlusion=ORM.AO");
  CHECK(maps_of("set.exr", {{"M"}, {"R"}}) == "roughness=R metallic=M");
  CHECK(maps_of("wall.exr", {{"arm", 3}}) == "roughness=arm:g metallic=arm:b ambient_occlusion=arm:r");
}

TEST_CASE("a file's name speaks of its picture, not of its depth or of other channels") {
  CHECK(maps_of("wall_basecolor.exr", {{"", 3}, {"Z"}}) == "base_color=");
  CHECK(maps_of("wall_basecolor.exr", {{"Z"}, {"", 4}}) == "base_color=");
  CHECK(maps_of("wall_rough.exr", {{"beauty", 4}, {"Z"}}) == "roughness=beauty");
  CHECK(recognised("wall_basecolor.exr", {{"", 3}, {"Z"}}).ignored ==
        std::vector<std::string>{"wall_basecolor.exr (layer Z)"});
  CHECK(maps_of("wall_basecolor.exr", {{"View.Combined", 4}, {"View.Depth"}}) == "base_color=View.Combined");
  CHECK(has_note(recognised("wall_basecolor.exr", {{"View.Combined", 4}, {"View.Depth"}}),
                 "depth is the distance from the camera"));
  CHECK(maps_of("wall.exr", {{"albedo", 3}, {"depth"}}) == "base_color=albedo height=depth");
  CHECK(maps_of("wall_rgh.exr", {{"value"}}) == "roughness=value");
  CHECK(maps_of("wall.exr", {{"", 3}, {"roughness"}}) == "base_color= roughness=roughness");
}

TEST_CASE("of two pictures that a file's name may mean neither is taken") {
  const Recognition r = recognised("wall_color.exr", {{"left", 3}, {"right", 3}});
  CHECK(r.maps.empty());
  CHECK(has_note(r, R"(warning: wall_color.exr: neither of its layers left and right says what it is; both are left )"
                    R"(out. Choose one with `maps`, as in {"base_color": "wall_color.exr:left"})"));
}

TEST_CASE("layers of several materials in one file are told apart by the words before the map") {
  const Recognition r = recognised("wall.exr", {{"moss.albedo", 3}, {"moss.height"}, {"rock.albedo", 3}});
  REQUIRE(r.materials.size() == 2);
  CHECK(r.materials[0].name == "wall_moss");
  CHECK(r.materials[1].name == "wall_rock");
}
