#include "core/jpeg_file.h"

#include <cstdint>
#include <fstream>
#include <iterator>
#include <vector>

namespace terrazzo {

namespace {

bool is_frame_header(uint8_t marker) {
  return marker >= 0xc0 && marker <= 0xcf && marker != 0xc4 && marker != 0xc8 && marker != 0xcc;
}

bool stands_alone(uint8_t marker) {
  return marker == 0x01 || (marker >= 0xd0 && marker <= 0xd8);
}

}  // namespace

JpegFacts read_jpeg_facts(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  const std::vector<char> file((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
  const auto byte = [&](size_t i) { return static_cast<uint8_t>(file[i]); };
  JpegFacts facts;
  size_t i = 0;
  while (i + 1 < file.size()) {
    // Outside segments lies entropy-coded data, in which 0xff is followed by 0.
    if (byte(i) != 0xff || byte(i + 1) == 0 || byte(i + 1) == 0xff) {
      i++;
      continue;
    }
    const uint8_t marker = byte(i + 1);
    i += 2;
    if (marker == 0xd9) {
      facts.complete = true;
      break;
    }
    if (stands_alone(marker)) continue;
    if (i + 1 >= file.size()) break;
    if (is_frame_header(marker) && i + 7 < file.size()) facts.components = byte(i + 7);
    i += size_t{byte(i)} << 8 | byte(i + 1);
  }
  return facts;
}

}  // namespace terrazzo
