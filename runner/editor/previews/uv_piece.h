#pragma once

#include <array>
#include <vector>

#include "core/image/image.h"

namespace terrazzo {

/// A part of a result that was taken from the exemplar as a whole.
struct UvPiece {
  struct Run {
    int y = 0, begin = 0, end = 0;  ///< pixels begin..end-1 of a row
    bool operator==(const Run&) const = default;
  };
  std::array<int, 2> shift{};  ///< from a pixel of the result to the exemplar's, modulo the exemplar's size
  std::vector<Run> runs{};     ///< of the result, by rows
  int64_t area = 0;            ///< pixels
  bool is_whole = true;        ///< false: it goes on where it was not looked at
};

/// The pixels around (x, y) that are connected by their sides and have the same shift. `uv`: as uv_as_fractions makes
/// it; (x, y) lies inside. Looks at 2048x2048 pixels at most. Throws Error if the image is no such map.
UvPiece uv_piece_at(const Image& uv, Size exemplar, int x, int y);

}  // namespace terrazzo
