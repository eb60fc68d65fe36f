#include "core/image_io/stored_values.h"

#include <limits>

#include <doctest/doctest.h>
#include <fmt/format.h>

#include "core/base/error.h"
#include "core/image/image_limits.h"
#include "core/image_io/image_file.h"
#include "tests/image_reads.h"
#include "tests/odd_images.h"
#include "tests/run_node.h"
#include "tests/texts.h"

using namespace terrazzo;
using namespace terrazzo::test;
namespace fs = std::filesystem;

namespace {

constexpr float nan_value = std::numeric_limits<float>::quiet_NaN(), infinite = std::numeric_limits<float>::infinity();

}  // namespace

TEST_CASE("pixels that are not finite take the mean of their neighbours, and it is said how many and where") {
  const TemporaryFolder folder;
  constexpr int side = 8;
  std::vector<float> ramp;
  for (int i = 0; i < side * side; i++) ramp.push_back(float(i % side) / 8);
  std::vector<float> holed = ramp;
  holed[3 * side + 5] = nan_value;
  holed[6 * side + 0] = -infinite;
  for (const std::string type : {"float", "half"}) {
    const fs::path path = folder.path() / fmt::format("{}.exr", type);
    write_odd(path, {.size = {side, side}, .type = type}, holed);
    const ReadImage r = read_with_warnings(path, Semantic::height);
    CHECK(r.pixels()[3 * side + 5] == 5.0f / 8);
    // Two columns of three, but for itself: 2 of 0 and 3 of 1/8.
    CHECK(r.pixels()[6 * side + 0] == doctest::Approx(3.0 / 8 / 5).epsilon(1e-3));
    for (size_t i = 0; i < ramp.size(); i++)
      if (i != 3 * side + 5 && i != 6 * side) CHECK(r.pixels()[i] == ramp[i]);
    CHECK(r.warnings == fmt::format("warning: {}.exr: 2 pixels are not finite (NaN or infinite), the first at (5, 3); "
                                    "replaced by the mean of their neighbours\n",
                                    type));
    CHECK(read_with_warnings(path, Semantic::mask).pixels()[6 * side] == 0);  // labels are not averaged
    const PixelRoom no_room{uint64_t{1} << 60};
    CHECK(read_with_warnings(path, Semantic::height).pixels() == r.pixels());
  }
}

TEST_CASE("what neighbours cannot fill is refused with the numbers") {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "x.exr";
  std::vector<float> pixels(64, 0.5f);
  for (int i = 8; i < 16; i++) pixels[size_t(i)] = nan_value;
  write_odd(path, {.size = {8, 8}, .type = "half"}, pixels);
  CHECK(contains(
      read_error(path, Semantic::height),
      "x.exr: 8 of its 64 pixels are not finite (NaN or infinite), the first at (0, 1); at most 5 % are filled "
      "from their neighbours"));
  pixels.assign(64 * 64, 0.5f);
  for (int y = 0; y < 14; y++)
    for (int x = 0; x < 14; x++) pixels[size_t(y) * 64 + size_t(x)] = infinite;
  write_odd(path, {.size = {64, 64}, .type = "float"}, pixels);
  CHECK(read_error(path, Semantic::height) == "");
  std::vector<float> wide(400 * 400, 0.5f);
  for (int y = 0; y < 40; y++)
    for (int x = 0; x < 40; x++) wide[size_t(y) * 400 + size_t(x)] = nan_value;
  write_odd(path, {.size = {400, 400}, .type = "float"}, wide);
  CHECK(contains(read_error(path, Semantic::height), "no value within 16 pixels of (0, 0) is finite"));
  const PixelRoom no_room{uint64_t{1} << 60};
  CHECK(contains(read_error(path, Semantic::height), "no value within 16 pixels of (0, 0) is finite"));
  write_odd(path, {.size = {1, 1}, .type = "float"}, {nan_value});
  CHECK(contains(read_error(path, Semantic::height), "1 of its 1 pixel"));
}

TEST_CASE("alpha of colours that is 0 everywhere is read as opaque; other channels and other maps stay") {
  const TemporaryFolder folder;
  for (const char* name : {"x.png", "x.tif", "x.tga"}) {
    const fs::path path = folder.path() / name;
    write_odd(path, {.size = {2, 1}, .channels = 4}, {1, 0.2f, 0, 0, 0.4f, 0.2f, 1, 0});
    const ReadImage r = read_with_warnings(path, Semantic::base_color);
    CHECK(r.pixels() == std::vector<float>{1, 0.2f, 0, 1, 0.4f, 0.2f, 1, 1});
    CHECK(contains(r.warnings, fmt::format("warning: {}: its alpha is 0 everywhere", name)));
    CHECK(read_with_warnings(path, Semantic::data).pixels()[3] == 0);
    CHECK(read_with_warnings(path, Semantic::data).warnings == "");
  }
  write_odd(folder.path() / "y.png", {.size = {2, 1}, .channels = 4}, {1, 0.2f, 0, 0, 1, 0.2f, 0, 0.2f});
  CHECK(read_with_warnings(folder.path() / "y.png", Semantic::base_color).pixels()[3] == 0);
}

TEST_CASE("colours of WebP are those under its alpha") {
  const TemporaryFolder folder;
  // Lossless, 3x1: 200, 100, 50 with alpha 255, 128 and 0.
  const Bytes webp = {0x52, 0x49, 0x46, 0x46, 0x24, 0x00, 0x00, 0x00, 0x57, 0x45, 0x42, 0x50, 0x56, 0x50, 0x38,
                      0x4c, 0x18, 0x00, 0x00, 0x00, 0x2f, 0x02, 0x00, 0x00, 0x10, 0x17, 0x30, 0x64, 0x83, 0x3c,
                      0x32, 0x02, 0x82, 0xa2, 0xe7, 0x4c, 0x8f, 0xc3, 0x08, 0x35, 0x88, 0xe8, 0x7f, 0x00};
  const fs::path path = folder.path() / "x.webp";
  write_bytes(path, webp);
  std::vector<float> right;
  for (const float alpha : {1.0f, 128 / 255.0f, 0.0f})
    for (const float v : {200 / 255.0f, 100 / 255.0f, 50 / 255.0f, alpha}) right.push_back(v);
  const ReadImage r = read_with_warnings(path, Semantic::base_color);
  CHECK(r.pixels() == right);
  CHECK(r.warnings == "");
  for (size_t i = 20; i < webp.size(); i++) {  // damage gives an error or a picture of that size
    Bytes damaged = webp;
    damaged[i] ^= 0x15;
    write_bytes(path, damaged);
    try {
      const size_t count = read_with_warnings(path, Semantic::base_color).pixels().size();
      CHECK(count > 0);
    } catch (const Error& e) {
      CHECK(contains(e.what(), "x.webp"));
    }
  }
  Bytes animated = {'R', 'I', 'F', 'F', 22, 0, 0, 0, 'W', 'E', 'B', 'P', 'V', 'P', '8', 'X', 10, 0, 0, 0, 0x12};
  animated.resize(30);
  write_bytes(path, animated);
  CHECK(contains(read_error(path, Semantic::height), "it is an animation with alpha; expected a single picture"));
}

TEST_CASE("colours that may be multiplied by alpha are told of where none is larger than it, and stay as they are") {
  const auto remarks = [](std::vector<float> values) {
    StoredValues stored(
        {.stored = {0, 0, 2, 1}, .channels = 4, .is_float = true, .is_colour = true, .may_be_premultiplied = true});
    const std::vector<float> before = values;
    stored.mend(std::span<float>(values));
    CHECK(values == before);
    return stored.remarks();
  };
  const auto told = remarks({0.4f, 0.2f, 0.1f, 0.5f, 0.8f, 0.4f, 0.2f, 1});
  REQUIRE(told.size() == 1);
  CHECK(told[0].text.find("no colour is larger than alpha") == 0);
  CHECK(remarks({0.8f, 0.4f, 0.2f, 0.5f, 0.8f, 0.4f, 0.2f, 1}).empty());
  CHECK(remarks({0, 0, 0, 0, 0.8f, 0.4f, 0.2f, 1}).empty());
}
