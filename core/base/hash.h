#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

namespace terrazzo {

/// A 128-bit XXH3 content digest. Equal content has an equal digest on every machine.
struct Digest {
  uint64_t high = 0;
  uint64_t low = 0;
  auto operator<=>(const Digest&) const = default;
  /// 32 lower-case hexadecimal digits.
  std::string hex() const;
  /// The inverse of hex(); false if `text` is not 32 hexadecimal digits.
  static bool parse(std::string_view text, Digest& out);
};

/// Feeds data into a Digest. Everything added is length-delimited or of fixed width (little endian), so two different
/// sequences of calls never feed the same bytes.
class Hasher {
 public:
  Hasher();
  ~Hasher();
  Hasher(const Hasher&) = delete;
  Hasher& operator=(const Hasher&) = delete;

  Hasher& add(std::string_view text);
  Hasher& add(const char* text) { return add(std::string_view(text)); }
  Hasher& add(const Digest& digest);
  Hasher& add(int64_t value);
  Hasher& add(int value) { return add(int64_t{value}); }
  Hasher& add(bool value) { return add(int64_t{value}); }
  /// The bits of the number; -0 counts as 0.
  Hasher& add(double value);
  /// Raw bytes, preceded by their count.
  Hasher& bytes(const void* data, size_t size);
  /// Raw bytes without a count, for content fed in pieces whose total length is added separately.
  Hasher& stream(const void* data, size_t size);
  Digest digest() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

inline uint64_t mix_bits(uint64_t v) {
  v ^= v >> 30;
  v *= 0xbf58476d1ce4e5b9ULL;
  v ^= v >> 27;
  v *= 0x94d049bb133111ebULL;
  return v ^ (v >> 31);
}

/// Extends `bits`, a result of random_bits(), by further counters.
template <typename... Counters>
uint64_t more_random_bits(uint64_t bits, Counters... counters) {
  ((bits = mix_bits(bits ^ (static_cast<uint64_t>(counters) + 0x9e3779b97f4a7c15ULL))), ...);
  return bits;
}

/// A counter-based random number that depends only on its arguments, so work can be done in any order and on any number
/// of threads. The same on every machine. (A chain of SplitMix64 finalizers; Steele et al. 2014.)
template <typename... Counters>
uint64_t random_bits(uint64_t seed, Counters... counters) {
  return more_random_bits(mix_bits(seed + 0x9e3779b97f4a7c15ULL), counters...);
}

/// 32 random bits mapped to [0, n) without division.
inline uint32_t below(uint32_t bits, uint32_t n) {
  return static_cast<uint32_t>((uint64_t{bits} * n) >> 32);
}

/// A double in [0, 1) from the upper 53 bits.
inline double unit_double(uint64_t bits) {
  return static_cast<double>(bits >> 11) * 0x1.0p-53;
}

}  // namespace terrazzo
