#pragma once

#include "core/base/hash.h"
#include "core/synthesis/steps/correction.h"

namespace terrazzo::test {

/// All of it goes on from one place of an exemplar.
inline Field one_piece(Size size) {
  Field field{size, {}};
  for (int y = 0; y < size.height; y++)
    for (int x = 0; x < size.width; x++) field.pixels.push_back({uint16_t(9 + x), uint16_t(11 + y)});
  return field;
}

/// One piece, but for the pixels in `wrong`, which show what begins at `place`.
inline Field with_wrong_place(Size size, const Rect& wrong, ExemplarPixel place) {
  Field field = one_piece(size);
  for (int y = wrong.y; y < wrong.bottom(); y++)
    for (int x = wrong.x; x < wrong.right(); x++)
      field.at(x, y) = {uint16_t(place.x + x - wrong.x), uint16_t(place.y + y - wrong.y)};
  return field;
}

/// Blocks from anywhere in an exemplar of 64x64 pixels.
inline Field rubble(int side, Size size) {
  Field field{size, std::vector<ExemplarPixel>(size_t(size.area()))};
  for (int y = 0; y < size.height; y++)
    for (int x = 0; x < size.width; x++) {
      const uint64_t r = random_bits(3, x / side, y / side);
      field.at(x, y) = {uint16_t(2 + below(uint32_t(r), 60 - side) + x % side),
                        uint16_t(2 + below(uint32_t(r >> 32), 60 - side) + y % side)};
    }
  return field;
}

/// What a field of that size is corrected by, with no similar pixels.
inline CorrectionLevel level_of(const PaddedLevel& exemplar, Size size, bool closed = false, FixedPixels fixed = {}) {
  static const std::vector<ExemplarPixel> none;
  return {.exemplar = exemplar,
          .similar = none,
          .level = 2,
          .window = PlaneWindow::all_of({size, closed, closed}),
          .phase = {},
          .fixed = std::move(fixed)};
}

}  // namespace terrazzo::test
