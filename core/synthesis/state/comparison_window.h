#pragma once

#include <array>
#include <vector>

namespace terrazzo {

/// A comparison window: offsets of the pixels around an output pixel that are compared with a candidate's
/// neighbourhood. Those that reject most candidates come first.
using Window = std::vector<std::array<int, 2>>;
/// All 24 pixels of the 5x5 neighbourhood, nearest first.
inline const Window& full_window() {
  static const Window window = {{0, -1}, {-1, 0}, {1, 0},  {0, 1}, {-1, -1}, {1, -1}, {-1, 1},  {1, 1},
                                {0, -2}, {-2, 0}, {2, 0},  {0, 2}, {-1, -2}, {1, -2}, {-2, -1}, {2, -1},
                                {-2, 1}, {2, 1},  {-1, 2}, {1, 2}, {-2, -2}, {2, -2}, {-2, 2},  {2, 2}};
  return window;
}
/// Eight pixels: the diagonal neighbours and those two steps away along the axes.
inline const Window& sparse_window() {
  static const Window window = {{-1, -1}, {1, -1}, {-1, 1}, {1, 1}, {0, -2}, {0, 2}, {-2, 0}, {2, 0}};
  return window;
}

}  // namespace terrazzo
