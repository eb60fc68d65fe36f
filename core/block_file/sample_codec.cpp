#include "core/block_file/sample_codec.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <optional>
#include <stdexcept>

#include <Imath/half.h>

namespace terrazzo {

namespace {

constexpr size_t chunk = 1024;

template <typename Integer, bool divided>
struct IntegerCoding {
  using Stored = Integer;
  static constexpr float max = Integer(-1);
  static float decode(Integer k) { return divided ? float(k) / max : float(k) * (1.0f / max); }
  static Integer encode(float v) { return v >= 0 && v <= 1 ? Integer(int(v * max + 0.5f)) : Integer(0); }
};

struct HalfCoding {
  using Stored = uint16_t;
  static float decode(uint16_t bits) { return imath_half_to_float(bits); }
  static uint16_t encode(float v) { return imath_float_to_half(v); }
};

template <typename Coding>
std::optional<std::vector<uint8_t>> try_coding(const float* samples, size_t count) {
  using Stored = typename Coding::Stored;
  std::vector<uint8_t> bytes(count * sizeof(Stored));
  Stored coded[chunk];
  for (size_t at = 0; at < count; at += chunk) {
    const size_t n = std::min(chunk, count - at);
    uint32_t different = 0;
    for (size_t i = 0; i < n; i++) {
      coded[i] = Coding::encode(samples[at + i]);
      different |= std::bit_cast<uint32_t>(Coding::decode(coded[i])) ^ std::bit_cast<uint32_t>(samples[at + i]);
    }
    if (different) return std::nullopt;
    std::memcpy(&bytes[at * sizeof(Stored)], coded, n * sizeof(Stored));
  }
  return bytes;
}

template <typename Coding>
void decode_as(const uint8_t* bytes, size_t count, float* out) {
  using Stored = typename Coding::Stored;
  Stored coded[chunk];
  for (size_t at = 0; at < count; at += chunk) {
    const size_t n = std::min(chunk, count - at);
    std::memcpy(coded, bytes + at * sizeof(Stored), n * sizeof(Stored));
    for (size_t i = 0; i < n; i++) out[at + i] = Coding::decode(coded[i]);
  }
}

using U8Divided = IntegerCoding<uint8_t, true>;
using U8Scaled = IntegerCoding<uint8_t, false>;
using U16Divided = IntegerCoding<uint16_t, true>;
using U16Scaled = IntegerCoding<uint16_t, false>;

}  // namespace

int sample_bytes(SampleCoding coding) {
  switch (coding) {
    case SampleCoding::u8_divided:
    case SampleCoding::u8_scaled:
      return 1;
    case SampleCoding::u16_divided:
    case SampleCoding::u16_scaled:
    case SampleCoding::half:
      return 2;
    case SampleCoding::full:
      return 4;
  }
  throw std::logic_error("unknown sample coding");
}

CodedSamples code_samples(const float* samples, size_t count) {
  if (auto bytes = try_coding<U8Divided>(samples, count)) return {SampleCoding::u8_divided, std::move(*bytes)};
  if (auto bytes = try_coding<U8Scaled>(samples, count)) return {SampleCoding::u8_scaled, std::move(*bytes)};
  if (auto bytes = try_coding<U16Divided>(samples, count)) return {SampleCoding::u16_divided, std::move(*bytes)};
  if (auto bytes = try_coding<U16Scaled>(samples, count)) return {SampleCoding::u16_scaled, std::move(*bytes)};
  if (auto bytes = try_coding<HalfCoding>(samples, count)) return {SampleCoding::half, std::move(*bytes)};
  const auto* raw = reinterpret_cast<const uint8_t*>(samples);
  return {SampleCoding::full, std::vector<uint8_t>(raw, raw + count * sizeof(float))};
}

void decode_samples(SampleCoding coding, const uint8_t* bytes, size_t count, float* out) {
  switch (coding) {
    case SampleCoding::u8_divided:
      return decode_as<U8Divided>(bytes, count, out);
    case SampleCoding::u8_scaled:
      return decode_as<U8Scaled>(bytes, count, out);
    case SampleCoding::u16_divided:
      return decode_as<U16Divided>(bytes, count, out);
    case SampleCoding::u16_scaled:
      return decode_as<U16Scaled>(bytes, count, out);
    case SampleCoding::half:
      return decode_as<HalfCoding>(bytes, count, out);
    case SampleCoding::full:
      std::memcpy(out, bytes, count * sizeof(float));
      return;
  }
}

}  // namespace terrazzo
