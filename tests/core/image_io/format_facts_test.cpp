#include "core/image_io/format_facts.h"

#include <bit>

#include <doctest/doctest.h>
#include <fmt/format.h>

#include "core/base/error.h"
#include "core/image/image_limits.h"
#include "core/image_io/image_file.h"
#include "tests/byte_writer.h"
#include "tests/image_reads.h"
#include "tests/run_node.h"
#include "tests/texts.h"

using namespace terrazzo;
using namespace terrazzo::test;
namespace fs = std::filesystem;

namespace {

struct Tiff {
  int photometric = 1, bits = 8, format = 1, channels = 1, extra = -1;
  bool is_big_endian = false;
  int tile = 0;  ///< side; the values are those of one tile
};

/// One row of pixels, or one tile.
Bytes make_tiff(const Tiff& tiff, const Bytes& values) {
  test::ByteWriter out{.is_big_endian = tiff.is_big_endian};
  out.text(tiff.is_big_endian ? "MM" : "II").number(42, 2);
  const uint64_t at_values = 8, at_bits = at_values + values.size() + values.size() % 2;
  const uint64_t at_formats = at_bits + 2 * uint64_t(tiff.channels);
  out.number(at_formats + 2 * uint64_t(tiff.channels), 4).add(values).zeros(values.size() % 2);
  for (int c = 0; c < tiff.channels; c++) out.number(uint64_t(tiff.bits), 2);
  for (int c = 0; c < tiff.channels; c++) out.number(uint64_t(tiff.format), 2);
  struct Entry {
    uint64_t tag, type, count, value;
  };
  const auto channels = uint64_t(tiff.channels), tile = uint64_t(tiff.tile);
  const uint64_t width = tile ? tile : values.size() * 8 / (channels * uint64_t(tiff.bits));
  std::vector<Entry> entries = {{256, 4, 1, width}, {257, 4, 1, tile ? tile : 1}};
  const auto per_channel = [&](uint64_t tag, uint64_t value, uint64_t at) {
    if (channels > 2)
      entries.push_back({tag, 3, channels, at});
    else
      entries.push_back({tag, 3, channels, channels == 2 ? value << 16 | value : value});
  };
  per_channel(258, uint64_t(tiff.bits), at_bits);
  entries.insert(entries.end(), {{259, 3, 1, 1}, {262, 3, 1, uint64_t(tiff.photometric)}});
  if (!tile) entries.push_back({273, 4, 1, at_values});
  entries.push_back({277, 3, 1, channels});
  if (!tile) entries.insert(entries.end(), {{278, 4, 1, 1}, {279, 4, 1, values.size()}});
  if (tile)
    entries.insert(entries.end(),
                   {{322, 4, 1, tile}, {323, 4, 1, tile}, {324, 4, 1, at_values}, {325, 4, 1, values.size()}});
  if (tiff.extra >= 0) entries.push_back({338, 3, 1, uint64_t(tiff.extra)});
  per_channel(339, uint64_t(tiff.format), at_formats);
  out.number(entries.size(), 2);
  for (const Entry& e : entries) {
    out.number(e.tag, 2).number(e.type, 2).number(e.count, 4);
    if (e.type == 3 && e.count == 1)
      out.number(e.value, 2).number(0, 2);
    else
      out.number(e.value, 4);
  }
  return out.number(0, 4).bytes;
}

Bytes float_bytes(const std::vector<float>& values) {
  std::vector<uint64_t> numbers;
  for (const float v : values) numbers.push_back(std::bit_cast<uint32_t>(v));
  return packed(numbers, 4);
}

struct Bmp {
  uint64_t header = 40, compression = 0;
  std::vector<uint64_t> masks{};
};

/// 1x1 pixel of 32 bits: blue, green, red and a fourth byte.
Bytes make_bmp(const Bmp& bmp, const Bytes& pixel) {
  test::ByteWriter out;
  const uint64_t begin = 14 + bmp.header + (bmp.header == 40 ? 4 * bmp.masks.size() : 0);
  out.text("BM").number(begin + pixel.size(), 4).number(0, 4).number(begin, 4).number(bmp.header, 4);
  out.number(pixel.size() / 4, 4).number(1, 4).number(1, 2).number(32, 2).number(bmp.compression, 4);
  out.number(pixel.size(), 4).zeros(16).add(packed(bmp.masks, 4));
  return out.zeros(begin - out.size()).add(pixel).bytes;
}

struct Dds {
  std::string_view code{};  ///< four letters; else `flags` and `masks`
  uint64_t flags = 4, bits = 0;
  std::vector<uint64_t> masks{0, 0, 0, 0};
  uint64_t caps = 0x1000, caps2 = 0, depth = 0;
  std::vector<uint64_t> dx10{};
};

/// 4x4 pixels.
Bytes make_dds(const Dds& dds, const Bytes& data) {
  test::ByteWriter out;
  out.text("DDS ").number(124, 4).number(0x1007 | (dds.depth ? 0x800000 : 0), 4).number(4, 4).number(4, 4);
  out.number(0, 4).number(dds.depth, 4).number(0, 4).zeros(44).number(32, 4).number(dds.flags, 4);
  out.text(dds.code).zeros(4 - dds.code.size()).number(dds.bits, 4).add(packed(dds.masks, 4));
  out.number(dds.caps, 4).number(dds.caps2, 4).zeros(12).add(packed(dds.dx10, 4));
  return out.add(data).bytes;
}

}  // namespace

TEST_CASE("TIFF that stores 0 as white is inverted at every depth, and alpha is not") {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "white.tif";
  const auto pixels = [&](const Tiff& tiff, const Bytes& values) {
    write_bytes(path, make_tiff(tiff, values));
    return read_with_warnings(path).pixels();
  };
  CHECK(pixels({.photometric = 0}, {0, 64, 255}) == std::vector<float>{1, 191 / 255.0f, 0});
  for (const bool big : {false, true}) {
    const Tiff tiff{.photometric = 0, .bits = 16, .is_big_endian = big};
    CHECK(pixels(tiff, packed({0, 16384, 65535}, 2, big)) == std::vector<float>{1, 49151 / 65535.0f, 0});
    CHECK(contains(read_with_warnings(path).warnings, "white.tif: it says that 0 is white; its values were inverted"));
  }
  CHECK(pixels({.photometric = 0, .bits = 32}, packed({0, 1u << 30, 0xffffffff}, 4)) ==
        std::vector<float>{1, 0.75f, 0});
  CHECK(pixels({.photometric = 0, .channels = 2, .extra = 2}, {0, 255, 64, 128}) ==
        std::vector<float>{1, 1, 191 / 255.0f, 128 / 255.0f});
  CHECK(pixels({.photometric = 0, .bits = 16, .channels = 2, .extra = 2}, packed({0, 65535, 16384, 32768}, 2)) ==
        std::vector<float>{1, 1, 49151 / 65535.0f, 32768 / 65535.0f});
  CHECK(pixels({.photometric = 0, .bits = 16, .tile = 16}, packed(std::vector<uint64_t>(256, 1), 2)) ==
        std::vector<float>(256, 65534 / 65535.0f));
  const PixelRoom no_room{uint64_t{1} << 60};  // read strip by strip to disk
  CHECK(pixels({.photometric = 0, .bits = 16}, packed({0, 65535}, 2)) == std::vector<float>{1, 0});
}

TEST_CASE("TIFF of floats that stores 0 as white, and of 24-bit floats, is refused") {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "odd.tif";
  write_bytes(path, make_tiff({.photometric = 0, .bits = 32, .format = 3}, float_bytes({0, 1})));
  CHECK(contains(read_error(path), "odd.tif: its photometric tag says that 0 is white"));
  write_bytes(path, make_tiff({.bits = 24, .format = 3}, Bytes(12, 0x3e)));
  CHECK(contains(read_error(path), "odd.tif: its values are 24-bit floats; expected 16 or 32 bits"));
  write_bytes(path, make_tiff({.photometric = 3, .channels = 2, .extra = 2}, {1, 128, 200, 255}));
  CHECK(contains(read_error(path), "odd.tif: it has a palette and another channel"));
}

TEST_CASE("colours of TIFF that are multiplied by alpha are divided by it") {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "alpha.tif";
  const auto read_as = [&](const Tiff& tiff, const Bytes& values) {
    write_bytes(path, make_tiff(tiff, values));
    return read_with_warnings(path, Semantic::base_color);
  };
  const Tiff associated{.photometric = 2, .channels = 4, .extra = 1};
  const ReadImage r = read_as(associated, {100, 50, 25, 128, 0, 0, 0, 0});
  CHECK(r.pixels() == std::vector<float>{199 / 255.0f, 100 / 255.0f, 50 / 255.0f, 128 / 255.0f, 0, 0, 0, 0});
  CHECK(r.warnings ==
        "warning: alpha.tif: it says that its colours are multiplied by alpha; they were divided by it. 1 pixel of "
        "alpha 0 stays black\n");
  {
    const PixelRoom no_room{uint64_t{1} << 60};
    CHECK(read_with_warnings(path, Semantic::base_color).pixels() == r.pixels());
  }
  for (const bool big : {false, true})
    CHECK(read_as({.photometric = 2, .bits = 16, .channels = 4, .extra = 1, .is_big_endian = big},
                  packed({10000, 5000, 2500, 32768}, 2, big))
              .pixels()[0] == 20000 / 65535.0f);
  CHECK(
      read_as({.photometric = 2, .bits = 32, .format = 3, .channels = 4, .extra = 1}, float_bytes({0.25f, 2, 0, 0.5f}))
          .pixels() == std::vector<float>{0.5f, 4, 0, 0.5f});
  CHECK(read_as({.channels = 2, .extra = 1}, {64, 128}).pixels()[0] == 128 / 255.0f);
  CHECK(read_as({.photometric = 2, .channels = 4, .extra = 2}, {100, 50, 25, 128}).pixels()[0] == 100 / 255.0f);
  CHECK(read_with_warnings(path).warnings == "");
  CHECK(contains(read_as({.photometric = 2, .channels = 4}, {100, 50, 25, 128}).warnings,
                 "it does not say what its fourth channel is"));
  CHECK(
      contains(read_as(associated, {100, 50, 25, 10}).warnings, "Colours larger than alpha in 1 pixel say otherwise"));
}

TEST_CASE("Lab, CMYK and other spaces without plain colours are refused in every format") {
  const TemporaryFolder folder;
  const auto trouble = [&](const char* name, const Bytes& bytes) {
    write_bytes(folder.path() / name, bytes);
    const std::string read = read_error(folder.path() / name);
    CHECK(contains(read, "RGB"));
    CHECK(contains(read, name));
    return read;
  };
  for (const int lab : {8, 9, 10})
    CHECK(contains(trouble("lab.tif", make_tiff({.photometric = lab, .channels = 3}, {255, 0, 0})), "it is Lab"));
  CHECK(contains(trouble("cmyk.tif", make_tiff({.photometric = 5, .channels = 4}, {0, 0, 0, 0})), "CMYK"));
  for (const auto& [mode, name] : {std::pair{4, "CMYK"}, {7, "multichannel"}, {8, "duotone"}, {9, "Lab"}})
    for (const int bits : {8, 16}) {
      test::ByteWriter psd{.is_big_endian = true};
      psd.text("8BPS").number(1, 2).zeros(6).number(4, 2).number(2, 4).number(2, 4).number(uint64_t(bits), 2);
      psd.number(uint64_t(mode), 2).zeros(12).number(0, 2).zeros(16 * size_t(bits) / 8);
      CHECK(contains(trouble("ink.psd", psd.bytes), fmt::format("it is {}", name)));
    }
  for (const auto& [space, name] : {std::pair{12, "CMYK"}, {14, "Lab"}, {24, "colour space 24"}}) {
    test::ByteWriter jp2{.is_big_endian = true};
    jp2.number(12, 4).text("jP  \r\n").number(0x870a, 2).number(20, 4).text("ftypjp2 ").zeros(4).text("jp2 ");
    jp2.number(45, 4).text("jp2h").number(22, 4).text("ihdr").zeros(14).number(15, 4).text("colr").number(1, 1);
    jp2.zeros(2).number(uint64_t(space), 4);
    CHECK(contains(trouble("ink.jp2", jp2.bytes), name));
  }
  write_bytes(folder.path() / "ink.jpg", make_cmyk_jpeg());
  CHECK(contains(read_error(folder.path() / "ink.jpg"), "CMYK"));
}

TEST_CASE("the fourth byte of BMP pixels is alpha only where the header says so") {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "x.bmp";
  const Bytes pixel = {10, 20, 30, 128};
  const std::vector<uint64_t> colours = {0xff0000, 0xff00, 0xff}, all = {0xff0000, 0xff00, 0xff, 0xff000000};
  const auto channels = [&](const Bmp& bmp) {
    write_bytes(path, make_bmp(bmp, pixel));
    CHECK(read_image_info(path).channels == read_with_warnings(path).image->channels());
    CHECK(read_with_warnings(path).pixels()[0] == 30 / 255.0f);
    return read_with_warnings(path).image->channels();
  };
  CHECK(channels({}) == 3);
  CHECK(contains(read_with_warnings(path).warnings,
                 "x.bmp: the fourth byte of its pixels is unused, as its header says"));
  CHECK(channels({.header = 108}) == 3);
  CHECK(channels({.compression = 3, .masks = colours}) == 3);
  CHECK(channels({.header = 124, .compression = 3, .masks = all}) == 4);
  CHECK(channels({.compression = 6, .masks = all}) == 4);
  write_bytes(path, make_bmp({.compression = 3, .masks = {0xff000000, 0xff0000, 0xff00}}, pixel));
  CHECK(contains(read_error(path), "its channels are not in the usual order"));
}

TEST_CASE("DDS comes with the channels that it stores; what is no flat picture is refused") {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "x.dds";
  const Bytes bc4 = {200, 100, 0, 0, 0, 0, 0, 0}, other = {77, 10, 0, 0, 0, 0, 0, 0};
  Bytes bc5 = bc4;
  bc5.insert(bc5.end(), other.begin(), other.end());
  const auto trouble = [&](const Dds& dds, const Bytes& data) {
    write_bytes(path, make_dds(dds, data));
    return read_error(path);
  };
  for (const Dds& dds : {Dds{.code = "ATI2"}, Dds{.code = "BC5U"}, Dds{.code = "DX10", .dx10 = {83, 3, 0, 1, 0}}}) {
    CHECK(trouble(dds, bc5) == "");
    CHECK(read_image_info(path).channels == 2);
    CHECK(read_with_warnings(path).image->read({3, 3, 1, 1}) == std::vector<float>{200 / 255.0f, 77 / 255.0f});
  }
  CHECK(trouble({.code = "ATI1"}, bc4) == "");
  CHECK(read_image_info(path).channels == 1);
  CHECK(contains(trouble({.code = "DXT1", .caps = 0x1008, .caps2 = 0xfe00}, Bytes(48)), "it is a cube map"));
  CHECK(contains(trouble({.code = "DX10", .dx10 = {83, 3, 4, 1, 0}}, bc5), "it is a cube map"));
  CHECK(contains(trouble({.code = "DX10", .dx10 = {83, 3, 0, 3, 0}}, bc5), "it is an array of 3 images"));
  CHECK(contains(trouble({.code = "DXT1", .caps2 = 0x200000, .depth = 2}, Bytes(16)), "it is a volume of 2 slices"));
  CHECK(contains(trouble({.code = "DXT4"}, bc5), "it is DXT4, whose colours are multiplied by alpha"));
  CHECK(contains(trouble({.code = "DX10", .dx10 = {99, 3, 0, 1, 0}}, bc5), "its format, number 99 of DXGI"));
  CHECK(contains(trouble({.code = "BC5S"}, bc5), "save it as PNG or EXR"));
  // Of these the library never comes back.
  CHECK(contains(trouble({.flags = 0x40, .bits = 16, .masks = {0xff, 0xff00, 0, 0}}, Bytes(32)), "neither compressed"));
  CHECK(contains(trouble({.flags = 0x40, .bits = 32, .masks = {0xffff, 0xffff0000, 0, 0}}, Bytes(64)), "neither"));
  CHECK(trouble({.flags = 0x41, .bits = 32, .masks = {0xff0000, 0xff00, 0xff, 0xff000000}}, Bytes(64, 9)) == "");
}

TEST_CASE("FITS is refused, as its numbers have no range") {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "x.fits";
  std::string text = fmt::format("{:<80}{:<80}", "SIMPLE  =                    T", "BITPIX  =                   16");
  text.resize(5760, ' ');
  write_bytes(path, Bytes(text.begin(), text.end()));
  CHECK(contains(read_error(path), "it is FITS"));
  CHECK(contains(error_of("load_map", {{"path", path.string()}}), "it is FITS"));
  CHECK_NOTHROW(require_readable_image(path));  // what is asked first does not take it for a text
}

TEST_CASE("integers of 32 bits that are ids are refused, shades are not") {
  const TemporaryFolder folder;
  write_bytes(folder.path() / "ids.tif", make_tiff({.bits = 32}, packed({0, 57, 4000}, 4)));
  CHECK(contains(read_error(folder.path() / "ids.tif"),
                 "its values are 32-bit integers up to 4000 of 4294967295: they seem to be ids or counts"));
  {
    const PixelRoom no_room{uint64_t{1} << 60};
    CHECK(contains(read_error(folder.path() / "ids.tif"), "they seem to be ids"));
  }
  write_bytes(folder.path() / "signed.tif", make_tiff({.bits = 32, .format = 2}, packed({0, 57, 0xfffffff0}, 4)));
  CHECK(contains(read_error(folder.path() / "signed.tif"), "up to 57 of 2147483647"));
  write_bytes(folder.path() / "one.tif",
              make_tiff({.photometric = 2, .bits = 32, .channels = 3}, packed({~0u, 57, 0}, 4)));
  CHECK(contains(read_error(folder.path() / "one.tif"), "up to 57"));
  write_bytes(folder.path() / "shades.tif", make_tiff({.bits = 32}, packed({0, 57, 0x80000000}, 4)));
  CHECK(read_error(folder.path() / "shades.tif") == "");
  write_bytes(folder.path() / "none.tif", make_tiff({.bits = 32}, packed({0, 0}, 4)));
  CHECK(read_error(folder.path() / "none.tif") == "");
}

TEST_CASE("TGA of 16-bit grey values is refused, and one of grey and alpha is read") {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "grey.tga";
  for (const uint64_t kind : {3, 11}) {
    test::ByteWriter out;
    out.number(0, 1).number(0, 1).number(kind, 1).zeros(9).number(2, 2).number(1, 2).number(16, 1).number(0, 1);
    if (kind == 11) out.number(1, 1);
    write_bytes(path, out.number(16384, 2).number(32768, 2).bytes);
    CHECK(contains(read_error(path), "its header says grey values of 16 bits, which TGA does not know; save it as"));
  }
  test::ByteWriter out;
  out.number(0, 1).number(0, 1).number(3, 1).zeros(9).number(2, 2).number(1, 2).number(16, 1).number(8, 1);
  write_bytes(path, out.number(0xff33, 2).number(0xff66, 2).bytes);
  CHECK(read_with_warnings(path).pixels() == std::vector<float>{0.2f, 1, 0.4f, 1});
}
