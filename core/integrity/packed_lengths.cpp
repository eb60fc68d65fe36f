#include "core/integrity/packed_lengths.h"

#include <array>

namespace terrazzo {

namespace {

constexpr uint32_t clear_table = 256, end_of_information = 257, most_codes = 4096;
constexpr int least_bits = 9, most_bits = 12;

class HighBitsFirst {
 public:
  explicit HighBitsFirst(std::span<const uint8_t> data) : data_(data) {}
  /// Nullopt at the end of the data.
  std::optional<uint32_t> next(int bits) {
    while (held_ < bits) {
      if (at_ == data_.size()) return std::nullopt;
      buffer_ = buffer_ << 8 | data_[at_++];
      held_ += 8;
    }
    held_ -= bits;
    return buffer_ >> held_ & ((uint32_t{1} << bits) - 1);
  }

 private:
  std::span<const uint8_t> data_;
  size_t at_ = 0;
  uint32_t buffer_ = 0;
  int held_ = 0;
};

/// The lengths of the strings that LZW codes stand for.
class CodeLengths {
 public:
  void clear() {
    next_ = end_of_information + 1;
    previous_ = 0;
  }
  /// TIFF widens codes one code early.
  int bits() const {
    int bits = least_bits;
    while (bits < most_bits && next_ + 1 >= uint32_t{1} << bits) bits++;
    return bits;
  }
  /// The length of the string, or nullopt if there can be no such code yet.
  std::optional<uint32_t> take(uint32_t code) {
    const bool is_newest = code == next_ && previous_ > 0;
    if (code >= clear_table && !is_newest && (code <= end_of_information || code >= next_)) return std::nullopt;
    const uint32_t length = code < clear_table ? 1 : is_newest ? previous_ + 1 : lengths_[code];
    if (previous_ > 0 && next_ < most_codes) lengths_[next_++] = previous_ + 1;
    previous_ = length;
    return length;
  }

 private:
  std::array<uint32_t, most_codes> lengths_{};
  uint32_t next_ = end_of_information + 1;
  uint32_t previous_ = 0;  ///< the length of the last string; 0 right after the table was cleared
};

}  // namespace

std::optional<uint64_t> lzw_length(std::span<const uint8_t> data) {
  HighBitsFirst codes(data);
  CodeLengths lengths;
  uint64_t sum = 0;
  while (const std::optional<uint32_t> code = codes.next(lengths.bits())) {
    if (*code == end_of_information) return sum;
    if (*code == clear_table) {
      lengths.clear();
      continue;
    }
    const std::optional<uint32_t> length = lengths.take(*code);
    if (!length) return std::nullopt;
    sum += *length;
  }
  return sum;
}

std::optional<uint64_t> packbits_length(std::span<const uint8_t> data) {
  constexpr uint8_t nothing = 128;
  uint64_t sum = 0;
  for (size_t at = 0; at + 1 < data.size();) {  // a last byte alone is padding
    const uint8_t count = data[at];
    at += count == nothing ? 1 : count < nothing ? size_t{count} + 2 : 2;
    if (at > data.size()) return std::nullopt;
    if (count != nothing) sum += count < nothing ? uint64_t{count} + 1 : uint64_t{257} - count;
  }
  return sum;
}

}  // namespace terrazzo
