#include "tests/odd_images.h"

#include <fstream>
#include <iterator>

#include <OpenImageIO/imageio.h>
#include <doctest/doctest.h>

namespace terrazzo::test {

namespace {

void add_big_endian(Bytes& out, uint32_t v) {
  for (int shift = 24; shift >= 0; shift -= 8) out.push_back(uint8_t(v >> shift));
}

void append(Bytes& out, const Bytes& more) {
  for (const uint8_t b : more) out.push_back(b);
}

uint32_t crc32(const uint8_t* data, size_t size) {
  uint32_t crc = 0xffffffff;
  for (size_t i = 0; i < size; i++) {
    crc ^= data[i];
    for (int bit = 0; bit < 8; bit++) crc = (crc >> 1) ^ (crc & 1 ? 0xedb88320 : 0);
  }
  return ~crc;
}

void add_chunk(Bytes& png, const char* type, const Bytes& content) {
  add_big_endian(png, uint32_t(content.size()));
  const size_t start = png.size();
  for (int i = 0; i < 4; i++) png.push_back(uint8_t(type[i]));
  append(png, content);
  add_big_endian(png, crc32(&png[start], png.size() - start));
}

/// A zlib stream of one stored block.
Bytes stored(const Bytes& content) {
  const auto size = uint16_t(content.size());
  Bytes out = {0x78, 0x01, 0x01, uint8_t(size), uint8_t(size >> 8), uint8_t(~size), uint8_t(~size >> 8)};
  append(out, content);
  uint32_t a = 1, b = 0;
  for (const uint8_t c : content) {
    a = (a + c) % 65521;
    b = (b + a) % 65521;
  }
  add_big_endian(out, b << 16 | a);
  return out;
}

}  // namespace

Bytes read_bytes(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

void write_bytes(const std::filesystem::path& path, const Bytes& bytes) {
  std::ofstream out(path, std::ios::binary);
  out.write(reinterpret_cast<const char*>(bytes.data()), std::streamsize(bytes.size()));
}

Bytes make_png(Size size, int bits, int color_type, const std::vector<Bytes>& rows, const Bytes& palette) {
  Bytes png = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
  Bytes header;
  add_big_endian(header, uint32_t(size.width));
  add_big_endian(header, uint32_t(size.height));
  for (const int v : {bits, color_type, 0, 0, 0}) header.push_back(uint8_t(v));
  add_chunk(png, "IHDR", header);
  if (!palette.empty()) add_chunk(png, "PLTE", palette);
  Bytes scanlines;
  for (const Bytes& row : rows) {
    scanlines.push_back(0);
    append(scanlines, row);
  }
  add_chunk(png, "IDAT", stored(scanlines));
  add_chunk(png, "IEND", {});
  return png;
}

Bytes make_tiff(Size size, int bits, int format, const Bytes& samples) {
  constexpr int entry_count = 10, samples_at = 8 + 2 + entry_count * 12 + 4;
  Bytes out = {'I', 'I', 42, 0, 8, 0, 0, 0, entry_count, 0};
  const std::pair<int, int> entries[entry_count] = {
      {256, size.width},  {257, size.height},         {258, bits},  {259, 1}, {262, 1}, {273, samples_at}, {277, 1},
      {278, size.height}, {279, int(samples.size())}, {339, format}};
  for (const auto& [tag, value] : entries) {
    const bool is_short = tag == 258 || tag == 259 || tag == 262 || tag == 277 || tag == 339;
    append(out, {uint8_t(tag), uint8_t(tag >> 8), uint8_t(is_short ? 3 : 4), 0, 1, 0, 0, 0});
    for (int shift = 0; shift < 32; shift += 8) out.push_back(uint8_t(value >> shift));
  }
  append(out, Bytes(4));
  append(out, samples);
  return out;
}

Bytes make_cmyk_jpeg() {
  Bytes out = {0xff, 0xd8, 0xff, 0xdb, 0x00, 0x43, 0x00};  // start, quantisation table
  append(out, Bytes(64, 0xff));
  const Bytes frame = {0xff, 0xc0, 0x00, 0x14, 0x08, 0x00, 0x08, 0x00, 0x08, 0x04, 'C',
                       0x11, 0x00, 'M',  0x11, 0x00, 'Y',  0x11, 0x00, 'K',  0x11, 0x00};
  append(out, frame);
  for (const uint8_t table : {0x00, 0x10}) {  // Huffman tables that know the symbol 0 alone
    append(out, {0xff, 0xc4, 0x00, 0x14, table, 0x01});
    append(out, Bytes(16));
  }
  const Bytes scan = {0xff, 0xda, 0x00, 0x0e, 0x04, 'C',  0x00, 'M',  0x00, 'Y',
                      0x00, 'K',  0x00, 0x00, 0x3f, 0x00, 0x00, 0xff, 0xd9};
  append(out, scan);
  return out;
}

void write_odd(const std::filesystem::path& path, const OddFile& file, const std::vector<float>& pixels) {
  const auto out = OIIO::ImageOutput::create(path.string());
  REQUIRE(out);
  OIIO::ImageSpec spec(file.size.width, file.size.height, file.channels, OIIO::TypeDesc(file.type));
  spec.x = file.x;
  spec.y = file.y;
  spec.full_x = file.display.x;
  spec.full_y = file.display.y;
  spec.full_width = file.display.empty() ? file.size.width : file.display.width;
  spec.full_height = file.display.empty() ? file.size.height : file.display.height;
  spec.tile_width = spec.tile_height = file.tile;
  spec.tile_depth = file.tile ? 1 : 0;
  if (!file.channel_names.empty()) {
    spec.channelnames = file.channel_names;
    spec.alpha_channel = -1;
  }
  spec.attribute("oiio:UnassociatedAlpha", 1);
  if (file.mip) spec.attribute("textureformat", "Plain Texture");
  for (const auto& [name, value] : file.attributes) spec.attribute(name, value);
  if (!file.compression.empty()) spec.attribute("compression", file.compression);
  std::vector<OIIO::ImageSpec> specs(file.images, spec);
  for (size_t i = 0; i < file.part_names.size(); i++) specs[i].attribute("oiio:subimagename", file.part_names[i]);
  for (size_t i = 0; i < file.part_x.size(); i++) specs[i].x = file.part_x[i];
  if (file.images > 1) {
    REQUIRE(out->open(path.string(), file.images, specs.data()));
  } else {
    REQUIRE_MESSAGE(out->open(path.string(), spec), out->geterror());
  }
  for (int i = 0; i < file.images; i++) {
    if (i) REQUIRE(out->open(path.string(), specs[size_t(i)], OIIO::ImageOutput::AppendSubimage));
    REQUIRE_MESSAGE(out->write_image(OIIO::TypeDesc::FLOAT, pixels.data()), out->geterror());
  }
  if (file.mip) {
    spec.width = spec.full_width = file.size.width / 2;
    spec.height = spec.full_height = file.size.height / 2;
    REQUIRE_MESSAGE(out->open(path.string(), spec, OIIO::ImageOutput::AppendMIPLevel), out->geterror());
    REQUIRE(out->write_image(OIIO::TypeDesc::FLOAT, pixels.data()));
  }
  REQUIRE(out->close());
}

}  // namespace terrazzo::test
