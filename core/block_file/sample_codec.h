#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace terrazzo {

/// The storage of float samples: the narrowest encoding that restores every bit. Integers encode k / max or k * (1 /
/// max): readers of image files compute one or the other, which differ in the last bit.
enum class SampleCoding : uint8_t { u8_divided, u8_scaled, u16_divided, u16_scaled, half, full };
inline constexpr int sample_coding_count = 6;

/// Bytes per sample.
int sample_bytes(SampleCoding coding);

struct CodedSamples {
  SampleCoding coding = SampleCoding::full;
  std::vector<uint8_t> bytes;
};

/// Lossless.
CodedSamples code_samples(const float* samples, size_t count);

/// `bytes` holds `count` samples; need not be aligned.
void decode_samples(SampleCoding coding, const uint8_t* bytes, size_t count, float* out);

}  // namespace terrazzo
