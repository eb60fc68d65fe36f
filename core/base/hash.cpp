#include "core/base/hash.h"

#include <bit>
#include <charconv>

#include <fmt/format.h>
#include <xxhash.h>

namespace terrazzo {

static_assert(std::endian::native == std::endian::little, "digests and files are little endian");

std::string Digest::hex() const {
  return fmt::format("{:016x}{:016x}", high, low);
}

bool Digest::parse(std::string_view text, Digest& out) {
  if (text.size() != 32) return false;
  const auto half = [&](size_t at, uint64_t& value) {
    const char* end = text.data() + at + 16;
    const auto r = std::from_chars(text.data() + at, end, value, 16);
    return r.ec == std::errc() && r.ptr == end;
  };
  return half(0, out.high) && half(16, out.low);
}

struct Hasher::State {
  XXH3_state_t* xxh = XXH3_createState();
  State() = default;
  State(const State&) = delete;
  State& operator=(const State&) = delete;
  ~State() { XXH3_freeState(xxh); }
};

Hasher::Hasher() : state_(new State) {
  XXH3_128bits_reset(state_->xxh);
}
Hasher::~Hasher() = default;

Hasher& Hasher::stream(const void* data, size_t size) {
  XXH3_128bits_update(state_->xxh, data, size);
  return *this;
}

Hasher& Hasher::bytes(const void* data, size_t size) {
  add(static_cast<int64_t>(size));
  return stream(data, size);
}

Hasher& Hasher::add(std::string_view text) {
  return bytes(text.data(), text.size());
}
Hasher& Hasher::add(const Digest& digest) {
  return stream(&digest, sizeof digest);
}
Hasher& Hasher::add(int64_t value) {
  return stream(&value, sizeof value);
}

Hasher& Hasher::add(double value) {
  if (value == 0) value = 0;
  return stream(&value, sizeof value);
}

Digest Hasher::digest() const {
  const XXH128_hash_t h = XXH3_128bits_digest(state_->xxh);
  return {h.high64, h.low64};
}

}  // namespace terrazzo
