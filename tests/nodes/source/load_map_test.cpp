#include <filesystem>

#include <doctest/doctest.h>

#include "core/base/error.h"
#include "core/image_io/image_file.h"
#include "core/material/material.h"
#include "tests/odd_images.h"
#include "tests/run_node.h"

using namespace terrazzo;
using namespace terrazzo::test;

TEST_CASE("one file becomes a map with the meaning it is given") {
  const TemporaryFolder folder;
  const std::string png = (folder.path() / "a.png").string(), exr = (folder.path() / "a.exr").string();
  const ImagePtr image =
      make_image({6, 4}, 3, [](int x, int y, int c) { return float(x * 8 + y * 4 + c * 40) / 255.0f; });
  write_image(*image, png, {}, [](double) {});
  write_image(*image, exr, {.format = FileFormat::exr, .depth = Depth::f16}, [](double) {});
  const auto info_of = [](const Params& params) { return run_node("load_map", params).get<Image>("image")->info(); };

  CHECK(run_node("load_map", {{"path", png}}).get<Image>("image")->pixels() == image->pixels());
  CHECK(info_of({{"path", png}}).color_space == "srgb_texture");
  CHECK(info_of({{"path", exr}}).color_space == "lin_rec709");
  CHECK(info_of({{"path", exr}}).depth == Depth::f16);
  CHECK(info_of({{"path", png}, {"semantic", "height"}}).color_space == "raw");
  CHECK(info_of({{"path", png}, {"color_space", "ACEScg"}}).color_space == "acescg");
  const ImageInfo normal = info_of({{"path", png}, {"semantic", "normal"}, {"normal_y", "down"}});
  CHECK(normal.semantic == Semantic::normal);
  CHECK(normal.normal_y == NormalY::down);
  CHECK_THROWS_AS(info_of({{"path", png}, {"color_space", "srbg"}}), Error);
  CHECK_THROWS_AS(info_of({{"path", png + "x"}}), Error);
}

TEST_CASE("the colour space that a PNG file says is read by load_map as by load_material") {
  const TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / "wall_basecolor.png";
  const auto write = [&](const std::string& space, const std::string& description) {
    ImageInfo info{.size = {4, 4}, .channels = 3, .semantic = Semantic::base_color, .color_space = space};
    write_image(*Image::from_floats(info, std::vector<float>(48, 0.5f)), path,
                {.depth = Depth::u16, .description = description}, [](double) {});
  };
  const auto spaces = [&](const std::string& semantic = "base_color") {
    const ImageInfo map =
        run_node("load_map", {{"path", path.string()}, {"semantic", semantic}}).get<Image>("image")->info();
    const MaterialPtr material =
        run_node("load_material", {{"path", folder.path().string()}}).get<Material>("material");
    return std::pair(map.color_space, material->maps().front().image->info().color_space);
  };
  using Pair = std::pair<std::string, std::string>;
  write("lin_rec709", "");  // gAMA 1
  CHECK(spaces() == Pair{"lin_rec709", "lin_rec709"});
  CHECK(run_node("load_map", {{"path", path.string()}}).says("wall_basecolor.png: read as lin_rec709, as it says"));
  CHECK(spaces("roughness").first == "raw");
  write("srgb_texture", "terrazzo: base_color color_space=lin_rec709");
  CHECK(spaces() == Pair{"lin_rec709", "lin_rec709"});
  write("lin_rec709", "terrazzo: base_color color_space=acescg");
  CHECK(spaces() == Pair{"acescg", "acescg"});
  write("srgb_texture", "terrazzo: base_color color_space=srgb_texture");
  CHECK(spaces() == Pair{"srgb_texture", "srgb_texture"});
  CHECK(run_node("load_map", {{"path", path.string()}}).notes.empty());
  write("srgb_texture", "");
  CHECK(spaces() == Pair{"srgb_texture", "srgb_texture"});
  write("srgb_texture", "terrazzo: roughness color_space=raw");
  CHECK(spaces().first == "srgb_texture");
  write("srgb_texture", "terrazzo: base_color color_space=nonsense");
  CHECK_THROWS_AS(spaces(), Error);
  CHECK_THROWS_AS(run_node("load_material", {{"path", folder.path().string()}}), Error);
}

TEST_CASE("what is odd about a file is noted") {
  const TemporaryFolder folder;
  const std::filesystem::path path = folder.path() / "odd.tif";
  write_odd(path, {.size = {3, 2}, .type = "float", .attributes = {{"Orientation", 6}}}, {0, 1, 2, 3, 4, 5});
  const NodeRun run = run_node("load_map", {{"path", path.string()}, {"semantic", "height"}});
  REQUIRE(run.notes.size() == 1);
  CHECK(run.notes[0] == "odd.tif: rotated upright, as its orientation tag (6) says");
}

TEST_CASE("a mask painted as transparency is warned of, an opaque one is not") {
  const TemporaryFolder folder;
  const std::string path = (folder.path() / "mask.png").string();
  const auto notes = [&](int channels, float alpha, const std::string& semantic) {
    const ImagePtr image =
        make_image({4, 4}, channels, [&](int x, int, int c) { return c == channels - 1 && x == 2 ? alpha : 1.0f; });
    write_image(*image, path, {}, [](double) {});
    return run_node("load_map", {{"path", path}, {"semantic", semantic}}).notes;
  };
  REQUIRE(notes(4, 0.5f, "mask").size() == 1);
  CHECK(notes(4, 0.5f, "mask")[0].find("output \"a\" of channel_split") != std::string::npos);
  REQUIRE(notes(2, 0, "mask").size() == 1);
  CHECK(notes(2, 0, "mask")[0].find("output \"g\"") != std::string::npos);
  CHECK(notes(4, 1, "mask").empty());
  CHECK(notes(3, 0, "mask").empty());
  CHECK(notes(4, 0.5f, "base_color").empty());
}
