#include "core/image_io/tga_codec.h"

#include <doctest/doctest.h>

#include "core/base/error.h"
#include "core/image_io/image_file.h"
#include "tests/byte_writer.h"
#include "tests/run_node.h"
#include "tests/texts.h"

using namespace terrazzo;
using namespace terrazzo::test;
namespace fs = std::filesystem;

namespace {

struct Tga {
  uint64_t type = 2, depth = 16, descriptor = 1;
  int attributes = -1;  ///< of an extension area; negative: there is none
};

/// 2x2 pixels.
Bytes make_tga(const Tga& tga, const Bytes& data) {
  test::ByteWriter out;
  out.number(3, 1).number(0, 1).number(tga.type, 1).zeros(9).number(2, 2).number(2, 2);
  out.number(tga.depth, 1).number(tga.descriptor, 1).text("id.").add(data);
  if (tga.attributes < 0) return out.bytes;
  const size_t area = out.size();
  out.number(495, 2).zeros(492).number(uint64_t(tga.attributes), 1).number(area, 4).number(0, 4);
  return out.text("TRUEVISION-XFILE.").zeros(1).bytes;
}

ImagePtr read(const fs::path& path) {
  ImagePtr image = read_image(path, {}, [](const std::string&) {});
  CHECK(read_image_info(path).channels == image->channels());
  return image;
}

std::vector<float> bytes_of(const ImagePtr& image) {
  std::vector<float> out = image->pixels();
  for (float& v : out) v = float(int(v * 255 + 0.5f));
  return out;
}

}  // namespace

TEST_CASE("the sixteenth bit of TGA pixels is alpha where the descriptor says so") {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "x.tga";
  // From the bottom: red, green with alpha; blue, grey with alpha.
  const Bytes pixels = packed({0x7c00, 0x83e0, 0x001f, 0xc210}, 2);
  const std::vector<float> right = {0, 0, 255, 0, 132, 132, 132, 255, 255, 0, 0, 0, 0, 255, 0, 255};
  write_bytes(path, make_tga({}, pixels));
  CHECK(bytes_of(read(path)) == right);
  write_bytes(path, make_tga({.descriptor = 0x21}, packed({0x001f, 0xc210, 0x7c00, 0x83e0}, 2)));
  CHECK(bytes_of(read(path)) == right);
  write_bytes(path, make_tga({.descriptor = 0x31}, packed({0xc210, 0x001f, 0x83e0, 0x7c00}, 2)));
  CHECK(bytes_of(read(path)) == right);
  Bytes runs = {0x80, 0x00, 0x7c, 0x02};
  for (const uint8_t b : packed({0x83e0, 0x001f, 0xc210}, 2)) runs.push_back(b);
  write_bytes(path, make_tga({.type = 10}, runs));
  CHECK(bytes_of(read(path)) == right);
  write_bytes(path, make_tga({.descriptor = 0}, pixels));
  CHECK(read(path)->channels() == 3);
  write_bytes(path, make_tga({.attributes = 3}, pixels));
  CHECK(bytes_of(read(path)) == right);
  write_bytes(path, make_tga({.attributes = 0}, pixels));
  CHECK(read(path)->channels() == 3);
}

TEST_CASE("the extension area says what the fourth channel of a TGA file is") {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "x.tga";
  Bytes pixels;
  for (int i = 0; i < 4; i++)
    for (const int v : {25, 50, 100, 128}) pixels.push_back(uint8_t(v));
  const auto first = [&](int attributes) {
    write_bytes(path, make_tga({.depth = 32, .descriptor = 8, .attributes = attributes}, pixels));
    std::vector<float> all = bytes_of(read(path));
    all.resize(all.size() / 4);
    return all;
  };
  CHECK(first(0) == std::vector<float>{100, 50, 25});
  CHECK(first(1) == std::vector<float>{100, 50, 25});
  CHECK(first(2) == std::vector<float>{100, 50, 25, 128});
  CHECK(first(3) == std::vector<float>{100, 50, 25, 128});
  CHECK(first(4) == std::vector<float>{199, 100, 50, 128});
}

TEST_CASE("TGA files of 16 bits that are cut off give an error") {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "x.tga";
  const Bytes good = make_tga({.type = 10}, {0x81, 0, 0, 0x80, 1, 0, 0x80, 2, 0});
  for (size_t size = 18; size < good.size(); size++) {
    write_bytes(path, Bytes(good.begin(), good.begin() + ptrdiff_t(size)));
    CHECK_THROWS_AS(read(path), Error);
  }
}
