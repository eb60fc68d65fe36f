#include "core/image_io/file_pixels.h"

#include <limits>

#include <doctest/doctest.h>

#include "core/file/scratch_file.h"
#include "core/image_io/image_file.h"
#include "tests/image_reads.h"
#include "tests/odd_images.h"
#include "tests/run_node.h"

using namespace terrazzo;
using namespace terrazzo::test;
namespace fs = std::filesystem;

namespace {

/// As long as it lives there is no room for pixels in memory.
struct NoRoom {
  PixelRoom all{uint64_t{1} << 60};
};

std::vector<float> waves(Size size, int channels) {
  std::vector<float> out;
  for (int64_t i = 0; i < size.area() * channels; i++) out.push_back(float((i * 37 + i / 11) % 256) / 255.0f);
  return out;
}

/// Colours of alpha 0.
std::vector<float> invisible(Size size) {
  std::vector<float> out = waves(size, 4);
  for (size_t i = 3; i < out.size(); i += 4) out[i] = 0;
  return out;
}

/// Files of all depths, orientations and ways to lie in a file, each with the semantic to read it as.
std::vector<std::pair<fs::path, Semantic>> odd_files(const fs::path& folder) {
  std::vector<std::pair<fs::path, Semantic>> out;
  const auto add = [&](const std::string& name, const OddFile& file, std::vector<float> pixels,
                       Semantic semantic = Semantic::data) {
    out.emplace_back(folder / name, semantic);
    write_odd(out.back().first, file, pixels);
  };
  const Size size{45, 30};
  add("plain.png", {.size = size, .channels = 3}, waves(size, 3));
  add("deep.png", {.size = size, .channels = 2, .type = "uint16"}, waves(size, 2));
  add("plain.jpg", {.size = size, .channels = 3}, waves(size, 3));
  add("odd_depth.tif", {.size = size, .type = "int16"}, waves(size, 1));
  add("tiled.tif", {.size = {70, 50}, .channels = 4, .tile = 16}, waves({70, 50}, 4));
  add("full.exr", {.size = size, .channels = 3, .type = "float"}, waves(size, 3));
  std::vector<float> holes = waves(size, 1);
  holes[7] = std::numeric_limits<float>::infinity();
  add("holes.exr", {.size = size, .type = "half"}, holes);
  add("invisible.exr", {.size = size, .channels = 4, .type = "half"}, invisible(size), Semantic::base_color);
  add("invisible.tif", {.size = size, .channels = 4}, invisible(size), Semantic::base_color);
  add("holed.exr", {.size = size, .type = "float"}, holes);
  std::vector<float> normals = waves(size, 3);
  for (float& v : normals) v = v * 2 - 1;
  add("signed.exr", {.size = size, .channels = 3, .type = "half"}, normals, Semantic::normal);
  add("window.exr", {.size = {20, 12}, .channels = 3, .type = "half", .display = {3, 3, 12, 8}, .x = 1, .y = 2},
      waves({20, 12}, 3));
  add("outside.exr", {.size = {20, 12}, .type = "float", .display = {0, 0, 12, 8}, .x = -5, .y = -4},
      waves({20, 12}, 1));
  for (int orientation = 1; orientation <= 8; orientation++)
    add("turned" + std::to_string(orientation) + ".tif",
        {.size = size, .channels = 3, .attributes = {{"Orientation", orientation}}}, waves(size, 3));
  return out;
}

}  // namespace

TEST_CASE("images that are read into a scratch file are those that are read into memory") {
  const TemporaryFolder folder;
  for (const auto& [path, semantic] : odd_files(folder.path())) {
    CAPTURE(path.filename().string());
    const ReadImage usual = read_with_warnings(path, semantic);
    const NoRoom full;
    const ReadImage spilled = read_with_warnings(path, semantic);
    CHECK(std::dynamic_pointer_cast<const FilePixels>(spilled.image->source()));
    CHECK(spilled.image->in_memory() == nullptr);
    CHECK(spilled.image->info() == usual.image->info());
    CHECK(spilled.image->digest() == usual.image->digest());
    CHECK(spilled.warnings == usual.warnings);
    CHECK(spilled.pixels() == usual.pixels());
    const Rect part{3, 2, 7, 5};
    CHECK(spilled.image->read(part) == usual.image->read(part));
  }
  CHECK(ScratchFile::shared().size() == 0);
}

TEST_CASE("channels are the same whether they are chosen in memory or when asked for") {
  const Size size{40, 30};
  ImageInfo info{.size = size, .channels = 3};
  const ImagePtr image = Image::from_floats(info, waves(size, 3));
  info.channels = 2;
  const ImagePtr usual = chosen_channels(image, info, {2, 0}, true);
  CHECK(usual->in_memory() != nullptr);
  const NoRoom full;
  const ImagePtr lazy = chosen_channels(image, info, {2, 0}, true);
  CHECK(lazy->in_memory() == nullptr);
  CHECK(lazy->digest() == usual->digest());
  CHECK(lazy->pixels() == usual->pixels());
  CHECK(lazy->read({1, 1, 1, 1}) ==
        std::vector<float>{1 - image->read({1, 1, 1, 1})[2], 1 - image->read({1, 1, 1, 1})[0]});
}

TEST_CASE("what is cut off is found too when it is read by rows") {
  const TemporaryFolder folder;
  const NoRoom full;
  for (const char* name : {"a.png", "a.jpg", "a.tif", "a.exr"}) {
    CAPTURE(name);
    const fs::path path = folder.path() / name;
    write_odd(path, {.size = {64, 64}, .channels = 3}, waves({64, 64}, 3));
    Bytes bytes = read_bytes(path);
    bytes.resize(bytes.size() * 2 / 3);
    write_bytes(path, bytes);
    CHECK_THROWS_AS(read_with_warnings(path, Semantic::data), Error);
  }
  CHECK(ScratchFile::shared().size() == 0);
}
