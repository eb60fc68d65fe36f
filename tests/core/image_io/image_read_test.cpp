#include <cmath>
#include <fstream>

#include <doctest/doctest.h>
#include <fmt/format.h>
#include <tbb/parallel_for.h>
#include <unistd.h>

#include "core/base/error.h"
#include "core/image_io/image_file.h"
#include "tests/image_reads.h"
#include "tests/odd_images.h"
#include "tests/run_node.h"
#include "tests/texts.h"

using namespace terrazzo;
using namespace terrazzo::test;
namespace fs = std::filesystem;

namespace {

std::vector<float> ramp(int count) {
  std::vector<float> out(count);
  for (int i = 0; i < count; i++) out[i] = float(i) / float(count - 1);
  return out;
}

}  // namespace

TEST_CASE("a cut-off or altered file gives an error or the right picture, never a wrong one") {
  const TemporaryFolder folder;
  const ImagePtr image = make_image({40, 30}, 3, [](int x, int y, int c) {
    return float((x * 5 + y * 3 + c * 60 + (random_bits(1, x, y, c) & 15)) % 256) / 255.0f;
  });
  struct Kind {
    const char* name;
    FileFormat format;
    Depth depth;
  };
  const Kind kinds[] = {{"a.png", FileFormat::png, Depth::u8},   {"b.png", FileFormat::png, Depth::u16},
                        {"a.jpg", FileFormat::jpeg, Depth::u8},  {"a.tif", FileFormat::tiff, Depth::u8},
                        {"b.tif", FileFormat::tiff, Depth::f32}, {"a.exr", FileFormat::exr, Depth::f16},
                        {"b.exr", FileFormat::exr, Depth::f32}};
  for (const Kind& k : kinds) {
    const fs::path path = folder.path() / k.name;
    write_image(*image, path, {.format = k.format, .depth = k.depth}, [](double) {});
    const Bytes good = read_bytes(path);
    const std::vector<float> right = read_with_warnings(path).pixels();
    for (const double part : {0.0, 0.01, 0.05, 0.2, 0.5, 0.8, 0.95, 0.99, 1.0}) {
      Bytes cut = good;
      cut.resize(part == 1.0 ? good.size() - 1 : size_t(double(good.size()) * part));
      write_bytes(path, cut);
      INFO(k.name << " cut to " << cut.size() << " of " << good.size() << " bytes");
      try {
        const std::vector<float> pixels = read_with_warnings(path).pixels();
        CHECK(pixels == right);
      } catch (const Error& e) {
        CHECK(contains(e.what(), path.string()));
      }
    }
    for (uint64_t i = 0; i < 24; i++) {  // whatever comes of it, it must come in an orderly way
      Bytes altered = good;
      for (int n = 0; n < 3; n++) altered[random_bits(2, i, n) % altered.size()] = uint8_t(random_bits(3, i, n));
      write_bytes(path, altered);
      try {
        for (const float v : read_with_warnings(path).pixels())
          if (!std::isfinite(v)) FAIL("not finite");
      } catch (const Error&) {
        continue;
      }
    }
  }
}

TEST_CASE("that the end of a file is missing shows before it is read, and whole files do not seem cut off") {
  const TemporaryFolder folder;
  const ImagePtr image =
      make_image({70, 50}, 3, [](int x, int y, int c) { return float(random_bits(1, x, y, c) & 255) / 255.0f; });
  const auto trouble_of = [](const fs::path& path) {
    try {
      require_readable_image(path);
    } catch (const Error& e) {
      return std::string(e.what());
    }
    return std::string();
  };
  for (const char* name : {"a.png", "a.jpg", "a.tif", "a.exr"}) {
    CAPTURE(name);
    const fs::path path = folder.path() / name;
    const FileFormat format = *format_from(path);
    write_image(*image, path, {.format = format, .depth = format == FileFormat::exr ? Depth::f16 : Depth::u8},
                [](double) {});
    CHECK(trouble_of(path) == "");
    const Bytes whole = read_bytes(path);
    Bytes more = whole;
    more.insert(more.end(), 100, 0xab);
    write_bytes(path, more);
    CHECK(trouble_of(path) == "");
    CHECK_NOTHROW(read_with_warnings(path));
    if (format == FileFormat::exr) continue;  // has no end to look for
    for (const size_t missing : {size_t{1}, size_t{2}, size_t{30}, whole.size() / 2}) {
      if (format == FileFormat::tiff && missing < whole.size() / 2) continue;  // the directory may come last
      Bytes cut = whole;
      cut.resize(whole.size() - missing);
      write_bytes(path, cut);
      CHECK(contains(trouble_of(path), "it is truncated: the end of the image is missing"));
      CHECK(read_error(path) != "");
    }
  }
  CHECK(contains(trouble_of(folder.path() / "b.png"), "there is no such file"));
}

TEST_CASE("files that are no images are refused, whatever their names say") {
  const TemporaryFolder folder;
  Bytes noise(5000);
  for (size_t i = 0; i < noise.size(); i++) noise[i] = uint8_t(random_bits(7, i));
  for (const char* extension : {"png", "jpg", "tif", "exr", "tga", "bmp", "hdr", "gif", "webp", "psd"}) {
    const fs::path path = folder.path() / fmt::format("noise.{}", extension);
    INFO(path.string());
    write_bytes(path, noise);
    CHECK(contains(read_error(path), "cannot read " + path.string()));
    write_bytes(path, {});
    CHECK(contains(read_error(path), "the file is empty"));
  }
  CHECK(contains(read_error(folder.path()), "it is a folder"));
  CHECK(contains(read_error(folder.path() / "noise.pgn"), "there is no such file (did you mean \"noise.png\"?)"));
}

TEST_CASE("what the system refuses is said") {
  const TemporaryFolder folder;
  fs::create_symlink("gone.png", folder.path() / "link.png");
  CHECK(contains(read_error(folder.path() / "link.png"), "link.png: it is a link to gone.png, which does not exist"));
  CHECK(contains(read_error(folder.path() / (std::string(300, 'n') + ".png")), "File name too long"));
  if (::geteuid() == 0) {
    MESSAGE("skipped the rest: root may read everything");
    return;
  }
  std::ofstream(folder.path() / "locked.png") << "x";
  fs::permissions(folder.path() / "locked.png", fs::perms::none);
  CHECK(contains(read_error(folder.path() / "locked.png"), "locked.png: Permission denied"));
}

TEST_CASE("absurd sizes in a header are refused before memory is asked for") {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "huge.png";
  write_bytes(path, make_png({100000, 100000}, 8, 2, {Bytes(30)}));
  CHECK(contains(read_error(path), "100000"));
  write_bytes(folder.path() / "huge.tif", make_tiff({100000, 100000}, 8, 1, Bytes(30)));
  CHECK(contains(read_error(folder.path() / "huge.tif"), "at most 2^31 values"));
  write_bytes(path, make_png({0, 4}, 8, 2, {Bytes(30)}));
  CHECK(contains(read_error(path), "cannot read"));
}

TEST_CASE("values come as k / 255 and k / 65535, halfs and floats as they are") {
  const TemporaryFolder folder;
  std::vector<Bytes> row8(1), row16(1);
  for (int k = 0; k < 256; k++) row8[0].push_back(uint8_t(k));
  for (int k = 0; k < 256; k++) row16[0].insert(row16[0].end(), {uint8_t(k * 7), uint8_t(k)});
  write_bytes(folder.path() / "8.png", make_png({256, 1}, 8, 0, row8));
  write_bytes(folder.path() / "16.png", make_png({256, 1}, 16, 0, row16));
  const ReadImage r8 = read_with_warnings(folder.path() / "8.png"), r16 = read_with_warnings(folder.path() / "16.png");
  CHECK(r8.image->info().depth == Depth::u8);
  CHECK(r16.image->info().depth == Depth::u16);
  for (int k = 0; k < 256; k++) {
    CHECK(r8.pixels()[k] == float(k) / 255.0f);
    CHECK(r16.pixels()[k] == float((k * 7 & 255) << 8 | k) / 65535.0f);
  }
  write_odd(folder.path() / "h.exr", {.size = {4, 1}, .type = "half"}, {0.1f, -2.0f, 1000.0f, 6e-8f});
  const ReadImage half = read_with_warnings(folder.path() / "h.exr");
  CHECK(half.image->info().depth == Depth::f16);
  CHECK(half.pixels() == std::vector<float>{0.0999755859375f, -2.0f, 1000.0f, 0x1p-24f});
  CHECK(half.warnings.empty());
}

TEST_CASE("palettes and low depths are expanded") {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "odd.png";
  write_bytes(path, make_png({4, 1}, 8, 3, {{2, 1, 0, 2}}, {255, 0, 0, 0, 128, 0, 1, 2, 3}));
  const ImagePtr indexed = read_with_warnings(path).image;
  REQUIRE(indexed->channels() == 3);
  CHECK(indexed->read({0, 0, 2, 1}) == std::vector<float>{1 / 255.0f, 2 / 255.0f, 3 / 255.0f, 0, 128 / 255.0f, 0});
  write_bytes(path, make_png({8, 1}, 1, 0, {{0xa1}}));
  CHECK(read_with_warnings(path).pixels() == std::vector<float>{1, 0, 1, 0, 0, 0, 0, 1});
  write_bytes(path, make_png({2, 1}, 4, 0, {{0xf3}}));
  CHECK(read_with_warnings(path).pixels() == std::vector<float>{1, 51 / 255.0f});
}

TEST_CASE("alpha leaves the colours alone") {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "alpha.png";
  write_bytes(path, make_png({2, 1}, 8, 6, {{200, 100, 50, 0, 10, 20, 30, 128}}));
  CHECK(read_with_warnings(path).pixels() == std::vector<float>{200 / 255.0f, 100 / 255.0f, 50 / 255.0f, 0, 10 / 255.0f,
                                                                20 / 255.0f, 30 / 255.0f, 128 / 255.0f});
  write_bytes(path, make_png({2, 1}, 8, 4, {{200, 0, 100, 128}}));
  CHECK(read_with_warnings(path).pixels() == std::vector<float>{200 / 255.0f, 0, 100 / 255.0f, 128 / 255.0f});
  for (const std::string name : {"a.tif", "a.tga"}) {
    write_odd(folder.path() / name, {.size = {2, 1}, .channels = 4}, {1, 0.2f, 0, 0, 1, 0.2f, 0, 0.2f});
    CHECK(read_with_warnings(folder.path() / name).pixels() == std::vector<float>{1, 0.2f, 0, 0, 1, 0.2f, 0, 0.2f});
  }
}

TEST_CASE("integers of other depths become floats, and the warning says so") {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "int.tif";
  struct Kind {
    int bits, format;
    Bytes samples;
    std::vector<float> expected;
  };
  const Kind kinds[] = {
      {32, 1, {0, 0, 0, 0, 0, 0, 0, 128, 255, 255, 255, 255}, {0, 0.5f, 1}},
      {32, 2, {0, 0, 0, 0, 0, 0, 0, 64, 255, 255, 255, 127}, {0, 0.5f, 1}},
      {16, 2, {0, 0, 0, 64, 255, 127}, {0, 0.5f, 1}},
  };
  for (const Kind& k : kinds)
    for (const Size size : {Size{3, 1}, Size{1, 3}}) {
      INFO(k.bits << " bits, format " << k.format);
      write_bytes(path, make_tiff(size, k.bits, k.format, k.samples));
      const ReadImage r = read_with_warnings(path);
      CHECK(r.image->info().depth == Depth::f32);
      for (int i = 0; i < 3; i++) CHECK(r.pixels()[i] == doctest::Approx(k.expected[i]).epsilon(1e-4));
      CHECK(contains(r.warnings, "converted to 32-bit floats"));
    }
  write_bytes(path, make_tiff({1, 1}, 64, 3, Bytes(8)));
  CHECK(contains(read_error(path), "save it as 32-bit float"));
}

TEST_CASE("too many channels and CMYK are refused with advice") {
  const TemporaryFolder folder;
  write_odd(folder.path() / "five.tif", {.size = {2, 2}, .channels = 5}, ramp(20));
  CHECK(contains(read_error(folder.path() / "five.tif"), "it has 5 channels"));
  write_bytes(folder.path() / "ink.jpg", make_cmyk_jpeg());
  CHECK(contains(read_error(folder.path() / "ink.jpg"), "CMYK"));
  CHECK(contains(read_error(folder.path() / "ink.jpg"), "convert it to RGB"));
}

TEST_CASE("of several images in a file the first is read, with a warning") {
  const TemporaryFolder folder;
  for (const std::string name : {"pages.tif", "moving.gif"}) {
    const fs::path path = folder.path() / name;
    write_odd(path, {.size = {4, 2}, .channels = 3, .images = 3}, std::vector<float>(24, 1.0f));
    const ReadImage r = read_with_warnings(path);
    CHECK(r.image->size() == Size{4, 2});
    CHECK(r.pixels()[0] == 1.0f);
    CHECK(contains(r.warnings, "holds several images"));
  }
}

TEST_CASE("formats that are read alone and never written are read too") {
  const TemporaryFolder folder;
  std::vector<float> grey(size_t{32} * 16 * 3, 0.5f);
  for (const char* extension : {"webp", "bmp", "gif", "hdr", "tga"}) {
    const fs::path path = folder.path() / fmt::format("grey.{}", extension);
    INFO(path.string());
    write_odd(path, {.size = {32, 16}, .channels = 3}, grey);
    const ReadImage r = read_with_warnings(path);
    CHECK(r.image->size() == Size{32, 16});
    CHECK(r.image->channels() >= 3);
    CHECK(r.pixels()[0] == doctest::Approx(0.5).epsilon(0.02));
    CHECK_FALSE(contains(r.warnings, "images"));
  }
}

TEST_CASE("tiled and mip-mapped files are read like others") {
  const TemporaryFolder folder;
  const std::vector<float> pixels = ramp(64 * 32);
  write_odd(folder.path() / "tiles.tif", {.size = {64, 32}, .type = "float", .tile = 16}, pixels);
  write_odd(folder.path() / "tiles.exr", {.size = {64, 32}, .type = "float", .tile = 16, .mip = true}, pixels);
  CHECK(read_with_warnings(folder.path() / "tiles.tif").pixels() == pixels);
  CHECK(read_with_warnings(folder.path() / "tiles.exr").pixels() == pixels);
}

TEST_CASE("channels of an EXR file are found by name, single ones whatever they are called") {
  const TemporaryFolder folder;
  for (const std::string name : {"Y", "Z", "height.V"}) {
    const fs::path path = folder.path() / "one.exr";
    write_odd(path, {.size = {2, 1}, .type = "float", .channel_names = {name}}, {0.25f, 0.5f});
    CHECK(read_with_warnings(path).pixels() == std::vector<float>{0.25f, 0.5f});
  }
  write_odd(folder.path() / "bgr.exr",
            {.size = {1, 1}, .channels = 3, .type = "float", .channel_names = {"B", "G", "R"}}, {0.25f, 0.5f, 0.75f});
  CHECK(read_with_warnings(folder.path() / "bgr.exr").pixels() == std::vector<float>{0.75f, 0.5f, 0.25f});
}

TEST_CASE("an orientation tag rotates the image upright") {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "turned.tif";
  // Stored rows: 0 1 2 / 3 4 5.
  const std::vector<std::pair<int, std::vector<int>>> expected = {
      {1, {0, 1, 2, 3, 4, 5}}, {2, {2, 1, 0, 5, 4, 3}}, {3, {5, 4, 3, 2, 1, 0}}, {4, {3, 4, 5, 0, 1, 2}},
      {5, {0, 3, 1, 4, 2, 5}}, {6, {3, 0, 4, 1, 5, 2}}, {7, {5, 2, 4, 1, 3, 0}}, {8, {2, 5, 1, 4, 0, 3}}};
  for (const auto& [orientation, order] : expected) {
    INFO(orientation);
    write_odd(path, {.size = {3, 2}, .type = "float", .attributes = {{"Orientation", orientation}}},
              {0, 1, 2, 3, 4, 5});
    const ReadImage r = read_with_warnings(path);
    CHECK(r.pixels() == std::vector<float>(order.begin(), order.end()));
    CHECK(r.image->width() == (orientation >= 5 ? 2 : 3));
    CHECK(read_image_info(path).size == r.image->size());
    CHECK(contains(r.warnings, "rotated upright") == (orientation != 1));
  }
}

TEST_CASE("normals stored as signed numbers are encoded") {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "normal.exr";
  write_odd(path, {.size = {1, 1}, .channels = 3, .type = "half"}, {-0.5f, 0.5f, 0.75f});
  const ReadImage r = read_with_warnings(path, Semantic::normal);
  CHECK(r.pixels() == std::vector<float>{0.25f, 0.75f, 0.875f});
  CHECK(contains(r.warnings, "signed numbers"));
  CHECK(read_with_warnings(path, Semantic::data).pixels()[0] == -0.5f);
}

TEST_CASE("many threads may read at once") {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "shared.png";
  const ImagePtr image = make_image({32, 32}, 3, [](int x, int y, int c) { return float(x * 7 + y + c) / 255.0f; });
  write_image(*image, path, {}, [](double) {});
  std::vector<Digest> digests(16);
  tbb::parallel_for(0, 16, [&](int i) { digests[i] = read_with_warnings(path).image->digest(); });
  for (const Digest& d : digests) CHECK(d == digests[0]);
}
