#pragma once

#include <string_view>

#include "tests/odd_images.h"

namespace terrazzo::test {

/// Puts files together from numbers and texts.
struct ByteWriter {
  Bytes bytes{};
  bool is_big_endian = false;

  ByteWriter& number(uint64_t v, int count) {
    for (int i = 0; i < count; i++) bytes.push_back(uint8_t(v >> 8 * (is_big_endian ? count - 1 - i : i)));
    return *this;
  }
  ByteWriter& text(std::string_view text) {
    bytes.insert(bytes.end(), text.begin(), text.end());
    return *this;
  }
  ByteWriter& zeros(size_t count) {
    bytes.resize(bytes.size() + count);
    return *this;
  }
  ByteWriter& add(const Bytes& more) {
    for (const uint8_t b : more) bytes.push_back(b);
    return *this;
  }
  size_t size() const { return bytes.size(); }
};

/// The bytes of numbers of `size` bytes each.
inline Bytes packed(const std::vector<uint64_t>& numbers, int size, bool is_big_endian = false) {
  ByteWriter out{.is_big_endian = is_big_endian};
  for (const uint64_t n : numbers) out.number(n, size);
  return out.bytes;
}

}  // namespace terrazzo::test
