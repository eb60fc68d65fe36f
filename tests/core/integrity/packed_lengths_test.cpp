#include "core/integrity/packed_lengths.h"

#include <vector>

#include <doctest/doctest.h>

using namespace terrazzo;

namespace {

/// The codes with so many bits each, high bits first.
std::vector<uint8_t> packed(const std::vector<uint32_t>& codes, int bits = 9) {
  std::vector<uint8_t> out;
  int at = 0;
  for (const uint32_t code : codes)
    for (int b = bits - 1; b >= 0; b--, at++) {
      if (at % 8 == 0) out.push_back(0);
      out.back() = uint8_t(out.back() | (code >> b & 1) << (7 - at % 8));
    }
  return out;
}

}  // namespace

TEST_CASE("LZW: the example of the TIFF specification stands for nine bytes") {
  CHECK(lzw_length(packed({256, 7, 258, 8, 8, 258, 6, 6, 257})) == 9);
  CHECK(lzw_length(packed({256, 7, 258, 259, 257})) == 6);
  CHECK(lzw_length(packed({256, 7, 258, 256, 7, 257})) == 4);
}

TEST_CASE("LZW: codes that cannot be there yet are no such data; what follows the end does not count") {
  CHECK_FALSE(lzw_length(packed({256, 7, 260, 257})).has_value());
  CHECK_FALSE(lzw_length(packed({256, 258, 257})).has_value());
  CHECK(lzw_length(packed({256, 7, 257, 7, 7, 7, 7})) == 1);
}

TEST_CASE("LZW: codes are widened one early") {
  std::vector<uint32_t> narrow{256};
  for (int i = 0; i < 254; i++) narrow.push_back(5);  // adds the entries 258 to 510
  std::vector<uint8_t> data = packed(narrow);
  // 255 codes of 9 bits fill 286 bytes and 7 bits of the next; one of 10 bits follows.
  REQUIRE(data.size() == 287);
  data.back() = uint8_t(data.back() | (257 >> 9));
  data.push_back(uint8_t(257 >> 1 & 0xff));
  data.push_back(uint8_t((257 & 1) << 7));
  CHECK(lzw_length(data) == 254);
}

TEST_CASE("PackBits: Apple's example stands for 24 bytes") {
  const std::vector<uint8_t> data = {0xfe, 0xaa, 0x02, 0x80, 0x00, 0x2a, 0xfd, 0xaa,
                                     0x03, 0x80, 0x00, 0x2a, 0x22, 0xf7, 0xaa};
  CHECK(packbits_length(data) == 24);
  CHECK(packbits_length(std::vector<uint8_t>{0x80, 0x00, 0x01}) == 1);
  CHECK_FALSE(packbits_length(std::vector<uint8_t>{0x02, 0x80, 0x00}).has_value());
  CHECK(packbits_length(std::vector<uint8_t>{0x00, 0x01, 0x00}) == 1);
}
