#pragma once

#include <array>
#include <cstdint>

#include "core/block_file/block_file.h"

/// Constants shared by the writer and reader of block files.
namespace terrazzo::block_format {

inline constexpr std::array<char, 8> magic = {'T', 'Z', 'V', 'A', 'L', 'U', 'E', '\0'};
inline constexpr uint32_t version = 6;
inline constexpr size_t header_bytes = 72;
/// A block's entry in the contents: raw and stored size, coding, checksum.
inline constexpr size_t block_entry_bytes = 4 + 4 + 1 + 8;

uint64_t checksum(const void* data, size_t size);

}  // namespace terrazzo::block_format
