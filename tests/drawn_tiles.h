#pragma once

#include <algorithm>
#include <memory>

#include "tests/exemplars.h"

namespace terrazzo::test {

/// Square tiles with joints, each of its own shade, which repeat.
struct DrawnTiles {
  explicit DrawnTiles(int side) : side(side) {
    elements.size = {4 * side, 4 * side};
    elements.count = 16;
    elements.certainty = 1;
    for (int y = 0; y < 4 * side; y++)
      for (int x = 0; x < 4 * side; x++) elements.at.push_back(uint16_t(y / side * 4 + x / side));
  }
  /// The same tiles, whose borders were found up to three pixels off.
  DrawnTiles crooked() const {
    DrawnTiles out = *this;
    const int size = 4 * side;
    for (int y = 0; y < size; y++)
      for (int x = 0; x < size; x++) {
        const int u = x + int(below(uint32_t(random_bits(21, y / 24, x / 36)), 7)) - 3;
        const int v = y + int(below(uint32_t(random_bits(22, y / 36, x / 24)), 7)) - 3;
        out.elements.at[size_t(y) * size_t(size) + size_t(x)] =
            elements.at[size_t(wrap(v, size)) * size_t(size) + size_t(wrap(u, size))];
      }
    return out;
  }
  FeaturesPtr features() const {
    const ImagePtr image = make_image(elements.size, 1, [&](int x, int y, int) {
      const auto noise = float(unit_double(random_bits(3, x, y)));
      if (std::min({x % side, y % side, side - 1 - x % side, side - 1 - y % side}) < 2) return 0.1f + 0.04f * noise;
      const int tile = y / side * 4 + x / side;
      return 0.4f + 0.5f * float(unit_double(random_bits(5, tile))) + 0.05f * noise;
    });
    return plain_features(image, true)->with(Lattice{2, {double(side), 0}, {0, double(side)}, 1});
  }
  /// `known`: the analysis knows the elements.
  IndexPtr index(bool known) const {
    FeaturesPtr f = features();
    if (known) f = f->with(std::make_shared<const Elements>(elements));
    return make_index(make_appearance(*f, {}, {}, Task()), 3, Task());
  }

  int side;
  Elements elements;
};

}  // namespace terrazzo::test
