#include <vector>

#include <doctest/doctest.h>

#include "core/base/error.h"
#include "core/image/image.h"

using namespace terrazzo;

namespace {

/// Every value of an integer type once, the last of them on.
template <typename T>
void check_integers(Size size, Depth depth) {
  const ImageInfo info{.size = size, .channels = 2, .depth = depth};
  std::vector<T> values(size_t(size.area()) * 2);
  std::vector<float> floats(values.size());
  for (size_t i = 0; i < values.size(); i++) {
    values[i] = T(T(-1) - T(i));
    floats[i] = float(values[i]) / float(T(-1));
  }
  const ImagePtr integers = Image::from_integers(info, values), image = Image::from_floats(info, floats);
  CHECK(integers->digest() == image->digest());
  CHECK(integers->pixels() == image->pixels());
  const Rect part{3, 2, size.width - 5, 4};
  CHECK(integers->read(part) == image->read(part));
  CHECK(integers->in_memory() == nullptr);
  CHECK(integers->source()->held_bytes() == values.size() * sizeof(T));
  CHECK(held(integers) == integers);
  CHECK(materialized(integers)->in_memory()[1] == floats[1]);
}

}  // namespace

TEST_CASE("integers that stay integers in memory are read as the floats that they mean") {
  check_integers<uint8_t>({16, 8}, Depth::u8);
  check_integers<uint16_t>({256, 128}, Depth::u16);
  CHECK_THROWS_AS(Image::from_integers({.size = {0, 1}}, std::vector<uint8_t>()), Error);
}

TEST_CASE("an image that is held is itself, one that is computed becomes floats in memory") {
  const ImagePtr floats = Image::from_floats({.size = {4, 4}}, std::vector<float>(16, 0.5f));
  CHECK(held(floats) == floats);
  const ImagePtr computed = Image::computed({.size = {4, 4}}, Digest{1, 2}, [](const Rect& r, float* out) {
    for (int64_t i = 0; i < r.area(); i++) out[i] = 0.25f;
  });
  const ImagePtr kept = held(computed);
  CHECK(kept != computed);
  REQUIRE(kept->in_memory());
  CHECK(kept->in_memory()[15] == 0.25f);
}
