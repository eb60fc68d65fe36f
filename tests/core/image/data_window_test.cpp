#include <filesystem>

#include <doctest/doctest.h>

#include "core/base/error.h"
#include "core/image_io/image_file.h"
#include "tests/odd_images.h"
#include "tests/run_node.h"
#include "tests/texts.h"

using namespace terrazzo;
using namespace terrazzo::test;
namespace fs = std::filesystem;

namespace {

struct Read {
  std::vector<float> pixels;
  Size size;
  std::vector<std::string> said;
};

Read read(const fs::path& path, const std::string& layer = "") {
  Read out;
  const ImagePtr image = read_image(
      path, {}, [&](const std::string& w) { out.said.push_back(w); }, layer);
  out.pixels = image->pixels();
  out.size = image->size();
  return out;
}

std::string trouble_of(const fs::path& path) {
  try {
    read_image_info(path);
  } catch (const Error& e) {
    return e.what();
  }
  return "";
}

}  // namespace

TEST_CASE("an EXR file comes as its display window, and it is told what of the data window is missing or left out") {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "window.exr";
  const auto said = [&](Size data, int x, int y, Rect display) {
    write_odd(path, {.size = data, .type = "float", .display = display, .x = x, .y = y},
              std::vector<float>(size_t(data.area()), 0.5f));
    const std::vector<std::string> all = read(path).said;
    REQUIRE(all.size() <= 1);
    return all.empty() ? "" : all.front();
  };
  CHECK(said({4, 3}, 5, -7, {5, -7, 4, 3}) == "");
  CHECK(said({8, 6}, -2, -1, {0, 0, 4, 4}) ==
        "warning: window.exr: its data window, 8x6 at (-2, -1), is larger than its display window; the display window "
        "of 4x4 was read: data outside of it is left out");
}

TEST_CASE("pixels without data are never content: the file is refused with what to do") {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "window.exr";
  write_odd(path, {.size = {2, 2}, .type = "half", .display = {0, 0, 4, 4}, .x = 1, .y = 1}, {1, 2, 3, 4});
  CHECK(
      contains(trouble_of(path),
               "window.exr: its data window, 2x2 at (1, 1), covers only a part of its display window, 4x4 at (0, 0): "
               "12 of 16 pixels have no data. Crop all maps of the material alike, with OpenImageIO by \"oiiotool FILE "
               "--cut 2x2+1+1 -o FILE\"; or, if it should be 0 there, fill it by \"oiiotool FILE --croptofull -o "
               "FILE\""));
  CHECK_THROWS_AS(read(path), Error);
  write_odd(path, {.size = {2, 2}, .type = "half", .display = {10, 20, 3, 2}, .x = 11, .y = 19}, {1, 2, 3, 4});
  CHECK(contains(trouble_of(path), "4 of 6 pixels have no data"));
  CHECK(contains(trouble_of(path), "--cut 2x1+11+20 -o FILE"));  // in the file's coordinates
}

TEST_CASE("data lies where its window says, from a negative origin too") {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "window.exr";
  write_odd(path, {.size = {3, 3}, .type = "float", .display = {10, 20, 2, 1}, .x = 9, .y = 19},
            {1, 2, 3, 4, 5, 6, 7, 8, 9});
  CHECK(read(path).size == Size{2, 1});
  CHECK(read(path).pixels == std::vector<float>{5, 6});
  CHECK(read_image_info(path).size == Size{2, 1});
  write_odd(path, {.size = {3, 2}, .type = "float", .display = {-5, -4, 2, 2}, .x = -6, .y = -4}, {1, 2, 3, 4, 5, 6});
  CHECK(read(path).pixels == std::vector<float>{2, 3, 5, 6});
}

TEST_CASE("a data window that shows nothing is refused before anything is decoded") {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "aside.exr";
  for (const auto& [x, y] : {std::pair{4, 0}, {-2, 0}, {0, 4}, {0, -2}}) {
    write_odd(path, {.size = {2, 2}, .type = "half", .display = {0, 0, 4, 4}, .x = x, .y = y}, {1, 2, 3, 4});
    CHECK(contains(trouble_of(path),
                   "lies wholly outside its display window, 4x4 at (0, 0), so that it shows nothing; "
                   "save it with a display window that holds the data"));
  }
}

TEST_CASE("where the windows of parts differ, the layer is named") {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "parts.exr";
  OddFile file{.size = {3, 2},
               .channels = 3,
               .type = "half",
               .display = {0, 0, 1, 1},
               .x = -1,
               .images = 2,
               .part_names = {"albedo", "normal"}};
  const std::vector<float> pixels(18, 0.5f);
  write_odd(path, file, pixels);
  CHECK(read(path, "albedo").said == read(path, "normal").said);
  CHECK(contains(read(path, "normal").said.at(0), "parts.exr: its data window, 3x2 at (-1, 0)"));
  file.part_x = {-1, 0};
  write_odd(path, file, pixels);
  CHECK(contains(read(path, "albedo").said.at(0), "parts.exr (layer albedo): its data window, 3x2 at (-1, 0)"));
  CHECK(contains(read(path, "normal").said.at(0), "parts.exr (layer normal): its data window, 3x2 at (0, 0)"));
  file.part_x = {-1, 4};
  write_odd(path, file, pixels);
  CHECK(read(path, "albedo").size == Size{1, 1});
  CHECK_THROWS_AS(read(path, "normal"), Error);
}
