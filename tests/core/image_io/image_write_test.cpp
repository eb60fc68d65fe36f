#include <chrono>
#include <fstream>
#include <iterator>
#include <thread>

#include <doctest/doctest.h>
#include <fmt/format.h>

#include "core/base/error.h"
#include "core/file/file_io.h"
#include "core/image_io/image_file.h"
#include "tests/odd_images.h"
#include "tests/run_node.h"
#include "tests/texts.h"

using namespace terrazzo;
using namespace terrazzo::test;
namespace fs = std::filesystem;

namespace {

ImagePtr read(const fs::path& path) {
  return read_image(path, {}, [](const std::string& warning) { FAIL_CHECK(warning); });
}

void write(const ImagePtr& image, const fs::path& path, Depth depth) {
  write_image(*image, path, {.format = *format_from(path), .depth = depth}, [](double) {});
}

/// Every value that a depth of `bits` can hold, in one channel.
ImagePtr every_value(int bits) {
  const float largest = bits == 8 ? 255.0f : 65535.0f;
  return make_image({256, bits == 8 ? 1 : 256}, 1, [&](int x, int y, int) { return float(y * 256 + x) / largest; });
}

}  // namespace

TEST_CASE("a PNG in memory has the bytes of one in a file") {
  const TemporaryFolder folder;
  write(every_value(8), folder.path() / "a.png", Depth::u8);
  std::ifstream file(folder.path() / "a.png", std::ios::binary);
  const std::vector<uint8_t> expected((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  CHECK(expected.size() > 100);
  CHECK(encoded_file(*every_value(8)) == expected);
}

TEST_CASE("every 8- and 16-bit value is written back exactly") {
  const TemporaryFolder folder;
  for (const std::string name : {"a.png", "a.tif"}) {
    write(every_value(8), folder.path() / name, Depth::u8);
    CHECK(read(folder.path() / name)->pixels() == every_value(8)->pixels());
    CHECK(read(folder.path() / name)->info().depth == Depth::u8);
    write(every_value(16), folder.path() / name, Depth::u16);
    CHECK(read(folder.path() / name)->pixels() == every_value(16)->pixels());
    CHECK(read(folder.path() / name)->info().depth == Depth::u16);
  }
}

TEST_CASE("halfs and floats are written as they are") {
  const TemporaryFolder folder;
  const ImagePtr image =
      make_image({17, 9}, 3, [](int x, int y, int c) { return float(x - 4) * 0.125f + float(y) * 4.0f + float(c); });
  for (const std::string name : {"a.tif", "a.exr"})
    for (const Depth depth : {Depth::f16, Depth::f32}) {
      INFO(name << " " << name_of(depth));
      write(image, folder.path() / name, depth);
      CHECK(read(folder.path() / name)->pixels() == image->pixels());
      CHECK(read(folder.path() / name)->info().depth == depth);
    }
}

TEST_CASE("a byte of the pixels that is altered later does not go unnoticed in a lossless file") {
  const TemporaryFolder folder;
  const ImagePtr image = make_image({60, 40}, 3, [](int x, int y, int c) {
    return float(x * 3 + y * 2 + c * 9 + int(random_bits(1, x, y, c) & 3)) / 255.0f;
  });
  const std::pair<const char*, Depth> kinds[] = {
      {"a.png", Depth::u8}, {"a.tif", Depth::u8}, {"a.exr", Depth::f16}, {"b.exr", Depth::f32}};
  for (const auto& [name, depth] : kinds) {
    const fs::path path = folder.path() / name;
    write(image, path, depth);
    const std::vector<float> right = read(path)->pixels();
    const std::string good = read_file(path);
    for (size_t i = 0; i < 32; i++) {
      std::string altered = good;
      altered[good.size() / 3 + i * good.size() / 100] ^= 0x15;
      write_text(path, altered);
      INFO(name << ", byte " << good.size() / 3 + i * good.size() / 100 << " of " << good.size());
      try {
        CHECK(read(path)->pixels() == right);
      } catch (const Error&) {
        continue;
      }
    }
  }
}

TEST_CASE("one to four channels survive every lossless format") {
  const TemporaryFolder folder;
  for (const std::string name : {"a.png", "a.tif", "a.exr"})
    for (int channels = 1; channels <= 4; channels++)
      for (const Semantic semantic : {Semantic::base_color, Semantic::data}) {
        INFO(name << " " << channels);
        const ImagePtr image = make_image(
            {5, 4}, channels, [](int x, int y, int c) { return float(x * 40 + y * 3 + c * 20) / 255.0f; }, semantic);
        const Depth depth = holds(*format_from(name), Depth::u8) ? Depth::u8 : Depth::f32;
        write(image, folder.path() / name, depth);
        CHECK(read(folder.path() / name)->channels() == channels);
        CHECK(read(folder.path() / name)->pixels() == image->pixels());
      }
}

TEST_CASE("JPEG keeps the picture about as it is, and leaves alpha out") {
  const TemporaryFolder folder;
  for (int channels = 1; channels <= 4; channels++) {
    const ImagePtr image =
        make_image({32, 32}, channels, [](int x, int y, int) { return float(x * 4 + y * 2) / 255.0f; });
    write(image, folder.path() / "a.jpg", Depth::u8);
    const ImagePtr back = read(folder.path() / "a.jpg");
    CHECK(back->channels() == (channels < 3 ? 1 : 3));
    const std::vector<float> a = image->pixels(), b = back->pixels();
    for (int i = 0; i < 32 * 32; i++) CHECK(std::abs(a[i * channels] - b[i * back->channels()]) < 0.03f);
  }
}

TEST_CASE("values out of range are clipped by integer depths, counted, and kept by floats") {
  const TemporaryFolder folder;
  const ImagePtr image = make_image({4, 1}, 1, [](int x, int, int) { return float(x) - 1.0f; });
  const Clipping clipped = write_image(*image, folder.path() / "a.png", {}, [](double) {});
  CHECK(clipped.values == 2);
  CHECK(clipped.all == 4);
  CHECK(clipped.least == -1);
  CHECK(clipped.most == 2);
  CHECK(read(folder.path() / "a.png")->pixels() == std::vector<float>{0, 0, 1, 1});
  CHECK(write_image(*image, folder.path() / "a.exr", {.format = FileFormat::exr, .depth = Depth::f16}, [](double) {
        }).values == 0);
  CHECK(read(folder.path() / "a.exr")->pixels() == image->pixels());
}

TEST_CASE("the same pixels give the same bytes, today and tomorrow") {
  const TemporaryFolder folder;
  const ImagePtr image = make_image({20, 20}, 3, [](int x, int y, int c) { return float(x + y + c) / 60.0f; });
  const std::vector<std::pair<std::string, Depth>> kinds = {
      {"png", Depth::u8}, {"tif", Depth::u16}, {"exr", Depth::f16}, {"jpg", Depth::u8}};
  for (const auto& [extension, depth] : kinds) write(image, folder.path() / fmt::format("first.{}", extension), depth);
  std::this_thread::sleep_for(std::chrono::milliseconds(1100));  // so that a time stamp would differ
  for (const auto& [extension, depth] : kinds) {
    INFO(extension);
    write(image, folder.path() / fmt::format("second.{}", extension), depth);
    CHECK(read_bytes(folder.path() / fmt::format("first.{}", extension)) ==
          read_bytes(folder.path() / fmt::format("second.{}", extension)));
  }
}

TEST_CASE("a progress callback that throws stops the writing of any format") {
  const TemporaryFolder folder;
  ImageInfo info{.size = {2048, 2048}, .channels = 1};
  const ImagePtr image =
      Image::computed(info, Digest{}, [](const Rect& r, float* out) { std::fill_n(out, r.area(), 0.5f); });
  for (const std::string name : {"a.png", "a.tif", "a.exr", "a.jpg"}) {
    const FileFormat format = *format_from(name);
    const Depth depth = format == FileFormat::exr ? Depth::f16 : Depth::u8;
    int calls = 0;
    CHECK_THROWS_AS(write_image(*image, folder.path() / name, {.format = format, .depth = depth},
                                [&](double) {
                                  calls++;
                                  throw Cancelled();
                                }),
                    Cancelled);
    CHECK(calls == 1);
  }
}

TEST_CASE("what cannot be written is said") {
  const TemporaryFolder folder;
  const ImagePtr image = make_image({2, 2}, 1, [](int, int, int) { return 0.0f; });
  CHECK_THROWS_WITH_AS(
      write_image(*image, folder.path() / "a.png", {.format = FileFormat::png, .depth = Depth::f16}, [](double) {}),
      doctest::Contains("PNG cannot hold half values"), Error);
  for (const std::string name : {"a.png", "a.tif", "a.exr", "a.jpg"}) {
    const FileFormat format = *format_from(name);
    const Depth depth = format == FileFormat::exr ? Depth::f16 : Depth::u8;
    CHECK_THROWS_AS(
        write_image(*image, folder.path() / "missing" / name, {.format = format, .depth = depth}, [](double) {}),
        Error);
  }
}

TEST_CASE("a full disk is an error in every format, never a cut-off file that counts as written") {
  const ImagePtr image =
      make_image({64, 64}, 3, [](int x, int y, int c) { return float((x * 37 + y * 91 + c) % 251) / 250.0f; });
  for (const FileFormat format : {FileFormat::png, FileFormat::exr, FileFormat::jpeg}) {
    CAPTURE(name_of(format));
    const Depth depth = format == FileFormat::exr ? Depth::f16 : Depth::u8;
    CHECK_THROWS_WITH_AS(write_image(*image, "/dev/full", {.format = format, .depth = depth}, [](double) {}),
                         "cannot write /dev/full: No space left on device", FileError);
  }
  CHECK_THROWS_WITH_AS(
      write_image(*image, "/dev/full", {.format = FileFormat::tiff, .depth = Depth::u8}, [](double) {}),
      doctest::Contains("cannot write /dev/full"), Error);
}

TEST_CASE("formats are told by their extensions, whatever their case") {
  CHECK(format_from("a.PNG") == FileFormat::png);
  CHECK(format_from("b/a.tiff") == FileFormat::tiff);
  CHECK(format_from("a.b.exr") == FileFormat::exr);
  CHECK(format_from("a.jpeg") == FileFormat::jpeg);
  CHECK_FALSE(format_from("a.bmp"));
  CHECK_FALSE(format_from("png"));
  CHECK(looks_like_image("x.TGA"));
  CHECK_FALSE(looks_like_image("SOURCE.txt"));
}
