#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "core/base/geometry.h"
#include "core/base/hash.h"

namespace terrazzo {

inline constexpr int most_elements = 65535;

/// The elements that an exemplar consists of: stones, bricks, tiles, slates. Regions cover all of it; each holds one
/// element and, up to their middle, the joints around it. Where the exemplar tiles, regions go on around its borders.
struct Elements {
  Size size;                 ///< the exemplar's
  std::vector<uint16_t> at;  ///< the region of each pixel, row by row: 0 to count - 1
  int count = 0;
  double certainty = 0;  ///< 0..1: how far the borders between regions stand out from what lies inside

  bool operator==(const Elements&) const = default;
  void add_to(Hasher& h) const {
    h.add(size.width).add(size.height).add(count).add(certainty).bytes(at.data(), at.size() * sizeof(uint16_t));
  }
};
/// Of each of them whether the exemplar's border cuts it. `wraps`: the exemplar tiles, and cuts none.
std::vector<uint8_t> cut_elements(const Elements& elements, bool wraps);
/// How many of them no border cuts.
int whole_elements(const Elements& elements, bool wraps);

/// The side of a square as large as the element that a pixel belongs to, in the mean of all pixels; in pixels.
double typical_side(const Elements& elements);

/// Null: none are known.
using ElementsPtr = std::shared_ptr<const Elements>;

}  // namespace terrazzo
