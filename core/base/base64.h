#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace terrazzo {

/// Encodes bytes in base64 (RFC 4648), as for data URIs.
inline std::string base64(std::span<const uint8_t> bytes) {
  constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  out.reserve(bytes.size() / 3 * 4 + 4);
  for (size_t i = 0; i < bytes.size(); i += 3) {
    const auto byte = [&](size_t at) -> uint32_t { return at < bytes.size() ? bytes[at] : 0; };
    const uint32_t bits = byte(i) << 16 | byte(i + 1) << 8 | byte(i + 2);
    for (size_t d = 0; d < 4; d++) out += i + d > bytes.size() ? '=' : digits[bits >> (18 - 6 * d) & 63];
  }
  return out;
}

}  // namespace terrazzo
