#include "core/integrity/picture_ends.h"

#include <doctest/doctest.h>
#include <fmt/format.h>

#include "core/base/error.h"
#include "core/image_io/image_file.h"
#include "tests/odd_images.h"
#include "tests/run_node.h"
#include "tests/texts.h"

using namespace terrazzo;
using namespace terrazzo::test;
namespace fs = std::filesystem;

namespace {

std::string trouble_of(const fs::path& path) {
  try {
    require_readable_image(path);
  } catch (const Error& e) {
    return e.what();
  }
  return "";
}

std::vector<float> noise(Size size, int channels) {
  std::vector<float> out(size_t(size.area()) * channels);
  for (size_t i = 0; i < out.size(); i++) out[i] = float(random_bits(5, i) & 255) / 255.0f;
  return out;
}

}  // namespace

TEST_CASE("files of all formats that are cut off are found without being decoded, and whole ones are not") {
  const TemporaryFolder folder;
  const Size size{70, 50};
  for (const char* extension : {"png", "jpg", "tif", "exr", "hdr", "tga", "bmp", "webp", "gif"}) {
    const fs::path path = folder.path() / fmt::format("a.{}", extension);
    CAPTURE(path.string());
    const bool is_float = contains("exr hdr", extension);
    write_odd(path, {.size = size, .channels = 3, .type = is_float ? "float" : "uint8"}, noise(size, 3));
    CHECK(trouble_of(path) == "");
    const Bytes whole = read_bytes(path);
    for (const double part : {0.2, 0.5, 0.8, 0.95}) {
      CAPTURE(part);
      Bytes cut = whole;
      cut.resize(size_t(double(whole.size()) * part));
      write_bytes(path, cut);
      CHECK_MESSAGE(contains(trouble_of(path), "cannot read"), trouble_of(path));
    }
  }
  for (const bool mip : {false, true}) {
    const fs::path path = folder.path() / "tiles.exr";
    write_odd(path, {.size = {64, 32}, .type = "half", .tile = 16, .mip = mip}, noise({64, 32}, 1));
    CHECK(trouble_of(path) == "");
  }
}

TEST_CASE("the end of an EXR file of several parts, of tiles or of levels is missed") {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "a.exr";
  const OddFile rows{.size = {64, 32}, .type = "half", .images = 3, .part_names = {"a", "b", "c"}};
  OddFile tiles = rows;
  tiles.tile = 16;
  const OddFile levels{.size = {64, 32}, .type = "half", .tile = 16, .mip = true};
  for (const OddFile& file : {rows, tiles, levels}) {
    write_odd(path, file, noise({64, 32}, 1));
    CHECK(trouble_of(path) == "");
    Bytes cut = read_bytes(path);
    CAPTURE(cut.size());
    // The smaller level may be missing: it is not read.
    cut.resize(file.mip ? cut.size() * 2 / 3 : cut.size() - 1);
    write_bytes(path, cut);
    CHECK(contains(trouble_of(path), "truncated"));
  }
}

TEST_CASE("one wrong byte in a compressed TIFF or JPEG file's pixels is no wrong picture") {
  const TemporaryFolder folder;
  const Size size{64, 64};
  std::vector<float> pixels = noise(size, 3);
  for (size_t i = 0; i < pixels.size(); i++) pixels[i] = float(i / 40 % 200) / 255.0f + pixels[i] * 0.1f;
  const fs::path path = folder.path() / "a.tif";
  write_image(*make_image(size, 3, [&](int x, int y, int c) { return pixels[size_t((y * 64 + x) * 3 + c)]; }), path,
              {.format = FileFormat::tiff}, [](double) {});
  const Bytes whole = read_bytes(path);
  const auto read = [](const fs::path& file) { return read_image(file, {}, [](const std::string&) {})->pixels(); };
  const std::vector<float> right = read(path);
  for (uint64_t i = 0; i < 32; i++) {
    Bytes altered = whole;
    altered[whole.size() / 4 + random_bits(9, i) % (whole.size() / 2)] ^= 0x10;
    write_bytes(path, altered);
    try {
      CHECK(read(path) == right);
    } catch (const Error& e) {
      CHECK(contains(e.what(), "damaged"));
    }
  }
  const fs::path jpeg = folder.path() / "a.jpg";
  write_odd(jpeg, {.size = size, .channels = 3}, pixels);
  Bytes cut = read_bytes(jpeg);
  cut.resize(cut.size() / 2);
  cut.insert(cut.end(), {0xff, 0xd9});
  write_bytes(jpeg, cut);
  CHECK_THROWS_AS(read(jpeg), Error);
}

TEST_CASE("LZW and PackBits of every layout of a TIFF file are sound, and most altered bytes of LZW are not") {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "a.tif";
  const Size size{70, 50};
  const auto read = [&] { return read_image(path, {}, [](const std::string&) {})->pixels(); };
  for (const std::string compression : {"lzw", "packbits"})
    for (const std::string type : {"uint8", "uint16", "float"})
      for (const int channels : {1, 3})
        for (const int tile : {0, 32})
          for (const int rows : {0, 7, 50, 64}) {
            INFO(fmt::format("{} {} {} {} {}", compression, type, channels, tile, rows));
            OddFile file{.size = size, .channels = channels, .type = type, .tile = tile, .compression = compression};
            if (rows > 0 && tile == 0) file.attributes["tiff:RowsPerStrip"] = rows;
            write_odd(path, file, noise(size, channels));
            CHECK_NOTHROW(read());
          }
  std::vector<float> pixels = noise(size, 3);
  for (size_t i = 0; i < pixels.size(); i++) pixels[i] = float(i / 40 % 200) / 255.0f + pixels[i] * 0.02f;
  write_odd(path, {.size = size, .channels = 3, .compression = "lzw"}, pixels);
  const Bytes whole = read_bytes(path);
  int told = 0;
  for (uint64_t i = 0; i < 32; i++) {
    Bytes altered = whole;
    altered[whole.size() / 4 + random_bits(9, i) % (whole.size() / 2)] ^= 0x10;
    write_bytes(path, altered);
    try {
      read();
    } catch (const Error&) {
      told++;
    }
  }
  CHECK(told >= 20);
}
