#pragma once

#include <cstdint>
#include <optional>
#include <span>

/// The unpacked length of compressed data, without unpacking it. The data has no checksum, but a damaged byte mostly
/// changes the length, and libtiff ignores what is too long. Nullopt if the data is invalid.
namespace terrazzo {

/// LZW as in TIFF 6.0, section 13: codes of 9 to 12 bits, high bits first. Ends with the end-of-information code or
/// with the data.
std::optional<uint64_t> lzw_length(std::span<const uint8_t> data);

/// PackBits as in TIFF 6.0, section 9.
std::optional<uint64_t> packbits_length(std::span<const uint8_t> data);

}  // namespace terrazzo
