#include <filesystem>

#include <doctest/doctest.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/base/error.h"
#include "core/image_io/image_file.h"
#include "tests/odd_images.h"
#include "tests/run_node.h"
#include "tests/texts.h"

using namespace terrazzo;
using namespace terrazzo::test;
namespace fs = std::filesystem;

namespace {

std::vector<std::string> listed(const fs::path& path) {
  std::vector<std::string> out;
  for (const FileInfo& i : read_layer_infos(path)) out.push_back(i.layer + ":" + std::to_string(i.channels));
  return out;
}

std::vector<float> pixels_of(const fs::path& path, const std::string& layer, std::string* said = nullptr) {
  const auto warn = [&](const std::string& text) {
    if (said) *said += text;
  };
  return read_image(path, {}, warn, layer)->pixels();
}

std::string error_of_layer(const fs::path& path, const std::string& layer) {
  try {
    pixels_of(path, layer);
  } catch (const Error& e) {
    return e.what();
  }
  return "";
}

}  // namespace

TEST_CASE("the layers of an EXR file are told by the prefixes of its channels and read with red first") {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "wall.exr";
  write_odd(path,
            {.size = {1, 1},
             .channels = 7,
             .type = "float",
             .channel_names = {"albedo.B", "albedo.G", "albedo.R", "height.Z", "Image.Normal.X", "Image.Normal.Y",
                               "Image.Normal.Z"}},
            {3, 2, 1, 4, 5, 6, 7});
  CHECK(listed(path) == std::vector<std::string>{"Image.Normal:3", "albedo:3", "height:1"});
  CHECK(pixels_of(path, "albedo") == std::vector<float>{1, 2, 3});
  CHECK(pixels_of(path, "HEIGHT") == std::vector<float>{4});
  CHECK(pixels_of(path, "Image.Normal") == std::vector<float>{5, 6, 7});
  CHECK(read_image_info(path, "height").channels == 1);
  CHECK(contains(error_of_layer(path, ""),
                 R"(it holds the layers "Image.Normal", "albedo", "height"; say which is meant)"));
  CHECK(contains(error_of_layer(path, "hieght"), R"(it has no layer "hieght" (did you mean "height"?); it holds)"));
}

TEST_CASE("channels without a layer are read where none is asked for, with a note on the others") {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "render.exr";
  write_odd(path,
            {.size = {1, 1}, .channels = 6, .type = "half", .channel_names = {"A", "B", "G", "R", "Z", "rough.Y"}},
            {4, 3, 2, 1, 5, 6});
  std::string said;
  CHECK(pixels_of(path, "", &said) == std::vector<float>{1, 2, 3, 4});
  CHECK(contains(said, R"(render.exr: its channels without a layer were read; it also holds "Z", "rough")"));
  CHECK(pixels_of(path, "Z") == std::vector<float>{5});
  CHECK(pixels_of(path, "rough") == std::vector<float>{6});
}

TEST_CASE("channels with names of their own are layers, whatever their order, beside a picture, a vector, or alone") {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "wall.exr";
  const auto layers = [&](const std::vector<std::string>& names) {
    std::vector<float> pixel;
    for (size_t i = 0; i < names.size(); i++) pixel.push_back(float(i + 1));
    write_odd(path, {.size = {1, 1}, .channels = int(names.size()), .type = "float", .channel_names = names}, pixel);
    return fmt::format("{}", fmt::join(listed(path), " "));
  };
  CHECK(layers({"AO", "Metallic", "Roughness"}) == "AO:1 Metallic:1 Roughness:1");
  CHECK(pixels_of(path, "metallic") == std::vector<float>{2});
  CHECK(contains(error_of_layer(path, ""), R"(it holds the layers "AO", "Metallic", "Roughness"; say which)"));
  CHECK(layers({"B", "G", "R", "Z"}) == ":3 Z:1");
  CHECK(pixels_of(path, "") == std::vector<float>{3, 2, 1});
  CHECK(layers({"A", "B", "G", "R", "Z"}) == ":4 Z:1");
  CHECK(layers({"Z", "albedo.B", "albedo.G", "albedo.R", "roughness"}) == "Z:1 roughness:1 albedo:3");
  CHECK(layers({"ORM.AO", "ORM.Metallic", "ORM.Roughness"}) == "ORM.AO:1 ORM.Metallic:1 ORM.Roughness:1");
  CHECK(layers({"ORM.B", "ORM.G", "ORM.R", "ORM.height"}) == "ORM:3 ORM.height:1");
  CHECK(layers({"Nx", "Ny", "Nz", "height"}) == "N:3 height:1");
  CHECK(layers({"albedo_b", "albedo_g", "albedo_r"}) == "albedo:3");
  CHECK(layers({"height", "u", "v"}) == "height:1 :2");
  CHECK(layers({"A", "Y"}) == ":2");
  CHECK(layers({"X", "Y", "Z"}) == ":3");
  CHECK(layers({"Y", "Z"}) == ":1 Z:1");
  CHECK(layers({"height"}) == "height:1");
  CHECK(pixels_of(path, "") == std::vector<float>{1});
  for (const char* name : {"R", "Y", "Z", "A", "1"}) CHECK(layers({name}) == ":1");
  CHECK(layers({"ch0", "ch1", "ch2"}) == ":3");
}

TEST_CASE("alpha without a layer belongs to the only other layer, beside several it is one of its own") {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "wall.exr";
  const auto layers = [&](const std::vector<std::string>& names) {
    std::vector<float> pixel;
    for (size_t i = 0; i < names.size(); i++) pixel.push_back(float(i + 1));
    write_odd(path, {.size = {1, 1}, .channels = int(names.size()), .type = "float", .channel_names = names}, pixel);
    return fmt::format("{}", fmt::join(listed(path), " "));
  };
  CHECK(layers({"A", "albedo.B", "albedo.G", "albedo.R"}) == "albedo:4");
  CHECK(pixels_of(path, "") == std::vector<float>{4, 3, 2, 1});
  CHECK(layers({"A", "Displacement.Y"}) == "Displacement:2");
  CHECK(pixels_of(path, "") == std::vector<float>{2, 1});
  CHECK(layers({"A", "normal.X", "normal.Y", "normal.Z"}) == "normal:4");
  CHECK(pixels_of(path, "") == std::vector<float>{2, 3, 4, 1});
  CHECK(layers({"A", "albedo.A", "albedo.B", "albedo.G", "albedo.R"}) == "A:1 albedo:4");
  CHECK(layers({"A", "albedo.B", "albedo.G", "albedo.R", "normal.X", "normal.Y", "normal.Z"}) ==
        "A:1 albedo:3 normal:3");
  CHECK(layers({"A", "five.1", "five.2", "five.3", "five.4"}) == "A:1 five:4");
}

TEST_CASE("the parts of an EXR file are layers") {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "parts.exr";
  write_odd(path, {.size = {1, 1}, .channels = 3, .type = "float", .images = 2, .part_names = {"color", "normal"}},
            {1, 2, 3});
  CHECK(listed(path) == std::vector<std::string>{"color:3", "normal:3"});
  CHECK(pixels_of(path, "normal") == std::vector<float>{1, 2, 3});
  write_odd(path,
            {.size = {1, 1},
             .channels = 3,
             .type = "float",
             .channel_names = {"color.R", "color.G", "color.B"},
             .images = 2,
             .part_names = {"color", "more"}},
            {1, 2, 3});
  CHECK(listed(path) == std::vector<std::string>{"color:3", "more.color:3"});
}

TEST_CASE("an EXR file of luminance and chroma is refused") {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "wall.exr";
  write_odd(path, {.size = {1, 1}, .channels = 3, .type = "half", .channel_names = {"BY", "RY", "Y"}}, {0, 0, 1});
  CHECK(
      contains(error_of_layer(path, ""), "it holds luminance and chroma (channels Y, RY, BY); save it with channels"));
}

TEST_CASE("other files have no layers") {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "one.tif";
  write_odd(path, {.size = {1, 1}}, {1});
  CHECK(listed(path) == std::vector<std::string>{":1"});
  CHECK(contains(error_of_layer(path, "red"), R"(it has no layer "red"; it holds no named layers)"));
  const fs::path exr = folder.path() / "many.exr";
  write_odd(exr, {.size = {1, 1}, .channels = 5, .type = "half", .channel_names = {"1", "2", "3", "4", "5"}},
            {1, 2, 3, 4, 5});
  CHECK(contains(error_of_layer(exr, ""), "it has 5 channels (1, 2, 3, 4, 5); expected 1 to 4"));
}
