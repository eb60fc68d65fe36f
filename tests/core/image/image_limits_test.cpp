#include "core/image/image_limits.h"

#include <algorithm>
#include <memory>

#include <doctest/doctest.h>

#include "core/filter/resample.h"
#include "core/image/pixel_buffer.h"

using namespace terrazzo;

namespace {

constexpr uint64_t mib = uint64_t{1} << 20;

/// A budget for a while.
struct Budget {
  explicit Budget(uint64_t bytes) { set_memory_budget(bytes); }
  ~Budget() { set_memory_budget(0); }
  Budget(const Budget&) = delete;
  Budget& operator=(const Budget&) = delete;
};

template <typename Act>
std::string error_of(const Act& act) {
  try {
    act();
  } catch (const TooManyPixels& e) {
    return e.what();
  }
  return "";
}

}  // namespace

TEST_CASE("a budget limits pixels, bytes and what is kept, and lets go of that again") {
  const uint64_t usual = PixelBuffer::memory_limit();
  const Size large{8000, 8000};
  CHECK(error_of([&] { require_pixels_fit("a.png", large, 3); }).empty());
  {
    const Budget budget(64 * mib);
    CHECK(memory_budget() == 64 * mib);
    CHECK(PixelBuffer::memory_limit() == 8 * mib);
    CHECK(error_of([] { require_pixels_fit("a.png", {4096, 4096}, 3); }).empty());
    CHECK(error_of([&] { require_pixels_fit("a.png", large, 3); }) ==
          "cannot read a.png: its header says 8000x8000, 64000000 pixels; with --memory 64M at most 59652323 are read. "
          "Scale it down first, or allow it with --max-pixels 64000000");
    CHECK_FALSE(PixelRoom::has(17 * mib));
  }
  CHECK(PixelBuffer::memory_limit() == usual);
  CHECK_FALSE(memory_budget_is_set());
}

TEST_CASE("files of more bytes than are allowed are refused") {
  const Budget budget(64 * mib);
  CHECK(error_of([] { require_bytes_fit("a.jpg", 256 * mib); }).empty());
  CHECK(error_of([] { require_bytes_fit("a.jpg", 256 * mib + 1); }) ==
        "cannot read a.jpg: the file has 268435457 bytes; at most 256.0 MiB are read. Scale it down first, "
        "or allow it with --max-bytes 257M");
  set_most_bytes(int64_t(mib));
  CHECK(error_of([] { require_bytes_fit("a.jpg", 2 * mib); }).find("as --max-bytes says") != std::string::npos);
  set_most_bytes(0);
}

TEST_CASE("what cannot be decoded by rows has to fit into the budget") {
  CHECK(error_of([] { require_decoding_fits("a.png", 100 * mib, "it is interlaced"); }).empty());
  const Budget budget(64 * mib);
  CHECK(error_of([] { require_decoding_fits("a.png", 64 * mib, "it is interlaced"); }).empty());
  CHECK(error_of([] { require_decoding_fits("a.png", 100 * mib, "it is interlaced"); }) ==
        "cannot read a.png with --memory 64M: it is interlaced, so all of it has to be in memory while it is decoded, "
        "100.0 MiB. Give --memory 100M, or save it as a plain PNG, TIFF or EXR file, which are read by rows");
}

namespace {

/// Pixels that lie nowhere; knows the largest region that has been read.
class Watched : public PixelSource {
 public:
  void read(const Rect& region, float* out) const override {
    largest = std::max(largest, region.area());
    std::fill_n(out, region.area(), 0.5f);
  }
  mutable int64_t largest = 0;
};

}  // namespace

TEST_CASE("what is scaled down is read in strips that the budget allows") {
  const auto watched = std::make_shared<Watched>();
  const ImageInfo info{.size = {4096, 4096}, .channels = 1};
  const ImagePtr image = Image::with_digest(info, Digest(), watched);
  const Budget budget(16 * mib);
  resampled(image, {512, 512}, "lanczos3", Outside::clamp, Digest())->pixels();
  CHECK(watched->largest > 0);
  CHECK(watched->largest <= int64_t(16 * mib) / 16);
}

TEST_CASE("room for pixels is given back with what has taken it") {
  const Budget budget(64 * mib);
  {
    PixelRoom some(10 * mib);
    const PixelRoom moved(std::move(some));
    CHECK_FALSE(PixelRoom::has(8 * mib));
  }
  CHECK(PixelRoom::has(8 * mib));
}
