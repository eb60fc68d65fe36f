#include <filesystem>

#include <doctest/doctest.h>

#include "core/base/error.h"
#include "core/image/image_file.h"
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
