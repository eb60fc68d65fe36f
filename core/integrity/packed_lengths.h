#pragma once

#include <cstdint>
#include <optional>
#include <span>

/// How many bytes packed data stands for, told without unpacking it: it has no checksum, but an altered byte mostly
/// gives another number. Nullopt if the data cannot be what it says.
namespace terrazzo {

/// LZW as in TIFF 6.0, section 13: codes of 9 to 12 bits, high bits first. Ends with the end-of-information code or
/// with the data.
std::optional<uint64_t> lzw_length(std::span<const uint8_t> data);

/// PackBits as in TIFF 6.0, section 9.
std::optional<uint64_t> packbits_length(std::span<const uint8_t> data);

}  // namespace terrazzo
