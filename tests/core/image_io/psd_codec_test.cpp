#include "core/image_io/psd_codec.h"

#include <bit>

#include <doctest/doctest.h>

#include "core/base/error.h"
#include "core/image_io/image_file.h"
#include "tests/byte_writer.h"
#include "tests/image_reads.h"
#include "tests/run_node.h"
#include "tests/texts.h"

using namespace terrazzo;
using namespace terrazzo::test;
namespace fs = std::filesystem;

namespace {

struct Psd {
  int version = 1, mode = 3, bits = 8, channels = 3;
  Size size{2, 1};
  Bytes palette{};
  int layers = 0;       ///< negative: the first channel after the colours is their transparency
  std::string block{};  ///< the key of a tagged block after the layers
  int compression = 0;
};

/// `composite`: what comes after the compression.
Bytes make_psd(const Psd& psd, const Bytes& composite) {
  const int word = psd.version == 2 ? 8 : 4;
  test::ByteWriter layers{.is_big_endian = true};
  if (psd.layers != 0) layers.number(2, word).number(uint64_t(psd.layers), 2).number(0, 4);
  if (!psd.block.empty()) layers.number(0, word).number(0, 4).text("8BIM").text(psd.block).number(0, word);
  test::ByteWriter out{.is_big_endian = true};
  out.text("8BPS").number(uint64_t(psd.version), 2).zeros(6).number(uint64_t(psd.channels), 2);
  out.number(uint64_t(psd.size.height), 4).number(uint64_t(psd.size.width), 4).number(uint64_t(psd.bits), 2);
  out.number(uint64_t(psd.mode), 2).number(psd.palette.size(), 4).add(psd.palette).number(4, 4).zeros(4);
  return out.number(layers.size(), word).add(layers.bytes).number(uint64_t(psd.compression), 2).add(composite).bytes;
}

ReadImage read_psd(const fs::path& path) {
  ReadImage out = read_with_warnings(path);
  CHECK(read_image_info(path).channels == out.image->channels());
  CHECK(read_image_info(path).depth == out.image->info().depth);
  return out;
}

std::vector<float> fractions(const std::vector<int>& values, int largest) {
  std::vector<float> out;
  for (const int v : values) out.push_back(float(v) / float(largest));
  return out;
}

}  // namespace

TEST_CASE("PSD files come with their alpha channel, at every depth") {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "x.psd";
  const Bytes planes = {200, 201, 100, 101, 50, 51, 0, 128};
  for (const int version : {1, 2}) {
    write_bytes(path, make_psd({.version = version, .channels = 4}, planes));
    CHECK(read_psd(path).pixels() == fractions({200, 100, 50, 0, 201, 101, 51, 128}, 255));
  }
  CHECK(read_psd(path).warnings == "");
  write_bytes(path, make_psd({.channels = 3}, planes));
  CHECK(read_psd(path).pixels() == fractions({200, 100, 50, 201, 101, 51}, 255));
  write_bytes(path, make_psd({.mode = 1, .channels = 2}, planes));
  CHECK(read_psd(path).pixels() == fractions({200, 100, 201, 101}, 255));
  write_bytes(path, make_psd({.bits = 16, .channels = 4, .size = {1, 1}}, packed({40000, 20000, 10000, 300}, 2, true)));
  CHECK(read_psd(path).pixels() == fractions({40000, 20000, 10000, 300}, 65535));
  std::vector<uint64_t> floats;
  for (const float v : {0.5f, 2.0f, -1.0f}) floats.push_back(std::bit_cast<uint32_t>(v));
  write_bytes(path, make_psd({.bits = 32, .size = {1, 1}}, packed(floats, 4, true)));
  CHECK(read_psd(path).pixels() == std::vector<float>{0.5f, 2, -1});
  write_bytes(path, make_psd({.channels = 6, .size = {1, 1}}, {1, 2, 3, 4, 5, 6}));
  CHECK(read_psd(path).pixels() == fractions({1, 2, 3, 4}, 255));
  CHECK(contains(read_psd(path).warnings, "of its extra channels the first is read, as alpha"));
}

TEST_CASE("palettes and packed rows of PSD files are expanded") {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "x.psd";
  Bytes palette(768);
  for (size_t c = 0; c < 3; c++) palette[c * 256 + 7] = uint8_t(10 * (c + 1));
  write_bytes(path, make_psd({.mode = 2, .channels = 1, .palette = palette}, {0, 7}));
  CHECK(read_psd(path).pixels() == fractions({0, 0, 0, 10, 20, 30}, 255));
  // Rows: five times 9; 1 2 3 and two times 4; 5 and four times 6.
  Bytes packed_rows = packed({2, 6, 4}, 2, true);
  for (const int b : {0xfc, 9, 2, 1, 2, 3, 0xff, 4, 0, 5, 0xfd, 6}) packed_rows.push_back(uint8_t(b));
  write_bytes(path, make_psd({.size = {5, 1}, .compression = 1}, packed_rows));
  CHECK(read_psd(path).pixels() == fractions({9, 1, 5, 9, 2, 6, 9, 3, 6, 9, 4, 6, 9, 4, 6}, 255));
}

TEST_CASE("colours under the transparency of layers are freed from white") {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "x.psd";
  // 200, 100, 50 at alpha 128 on white; and at alpha 0.
  const Bytes planes = {227, 255, 177, 255, 152, 255, 128, 0};
  for (const Psd& psd : {Psd{.channels = 4, .layers = -1}, Psd{.channels = 4, .block = "Mtrn"},
                         Psd{.version = 2, .channels = 4, .block = "Mt16"}}) {
    write_bytes(path, make_psd(psd, planes));
    CHECK(read_psd(path).pixels() == fractions({199, 100, 50, 128, 255, 255, 255, 0}, 255));
    CHECK(contains(read_psd(path).warnings, "the white was removed"));
  }
  write_bytes(path, make_psd({.channels = 4, .layers = 1}, planes));
  CHECK(read_psd(path).pixels()[0] == 227 / 255.0f);
}

TEST_CASE("PSD files that are cut off or damaged give an error") {
  const TemporaryFolder folder;
  const fs::path path = folder.path() / "x.psd";
  const auto is_refused = [&](const Bytes& bytes) {
    write_bytes(path, bytes);
    CHECK_THROWS_AS(read_image(path, {}, [](const std::string&) {}), Error);
  };
  const Bytes good = make_psd({.size = {4, 4}}, Bytes(48));
  for (size_t size = 1; size < good.size(); size++) is_refused(Bytes(good.begin(), good.begin() + ptrdiff_t(size)));
  is_refused(make_psd({.compression = 1}, {0, 2, 0, 2, 0, 2, 0x10, 1}));
  is_refused(make_psd({.compression = 3}, Bytes(48)));
  is_refused(make_psd({.mode = 2, .channels = 1, .palette = Bytes(6)}, {}));
}
