#include "tests/core/metrics/textures.h"

#include "core/base/hash.h"

namespace terrazzo::test {

namespace {

float random_unit(uint64_t seed, int x, int y) {
  return float(unit_double(random_bits(seed, x, y)));
}

}  // namespace

Planes bricks(Size size, uint64_t seed) {
  constexpr int brick_width = 16, brick_height = 8;
  Planes out = Planes::zeros(size, 1);
  for (int y = 0; y < size.height; y++)
    for (int x = 0; x < size.width; x++) {
      const int course = y / brick_height, along = x + (course % 2) * brick_width / 2;
      const bool mortar = y % brick_height < 2 || along % brick_width < 2;
      const float shade = mortar ? 0.2f : 0.5f + 0.3f * random_unit(seed, along / brick_width, 1000 + course);
      out.at(x, y)[0] = shade + 0.1f * random_unit(seed + 1, x, y);
    }
  return out;
}

Planes spots(Size size, uint64_t seed) {
  constexpr int cell = 12;
  Planes out = Planes::zeros(size, 1);
  for (int y = 0; y < size.height; y++)
    for (int x = 0; x < size.width; x++) {
      const int cx = x / cell, cy = y / cell;
      const float dx = float(x % cell) - 4 - 3 * random_unit(seed, cx, cy);
      const float dy = float(y % cell) - 4 - 3 * random_unit(seed + 1, cx, cy);
      out.at(x, y)[0] = (dx * dx + dy * dy < 12 ? 0.9f : 0.3f) + 0.1f * random_unit(seed + 2, x, y);
    }
  return out;
}

Planes tiled(const Planes& exemplar, Size size) {
  Planes out = Planes::zeros(size, exemplar.channels);
  for (int y = 0; y < size.height; y++)
    for (int x = 0; x < size.width; x++)
      std::copy_n(exemplar.at(x % exemplar.size.width, y % exemplar.size.height), exemplar.channels, out.at(x, y));
  return out;
}

Planes shuffled(const Planes& image, uint64_t seed) {
  Planes out = image;
  for (int64_t i = image.size.area() - 1; i > 0; i--) {
    const size_t j = random_bits(seed, i) % uint64_t(i + 1);
    std::swap_ranges(&out.values[size_t(i) * out.channels], &out.values[size_t(i) * out.channels] + out.channels,
                     &out.values[j * out.channels]);
  }
  return out;
}

Planes random_blocks(const Planes& exemplar, Size size, int block, uint64_t seed) {
  Planes out = Planes::zeros(size, exemplar.channels);
  for (int y = 0; y < size.height; y++)
    for (int x = 0; x < size.width; x++) {
      const int bx = x / block, by = y / block;
      const int from_x = int(random_bits(seed, bx, by, 0) % uint64_t(exemplar.size.width - block + 1)) + x % block;
      const int from_y = int(random_bits(seed, bx, by, 1) % uint64_t(exemplar.size.height - block + 1)) + y % block;
      std::copy_n(exemplar.at(from_x, from_y), exemplar.channels, out.at(x, y));
    }
  return out;
}

}  // namespace terrazzo::test
