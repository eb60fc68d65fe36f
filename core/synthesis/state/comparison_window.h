#pragma once

#include <array>
#include <vector>

namespace terrazzo {

/// A comparison window: offsets of the pixels around an output pixel that are compared with a candidate's
/// neighbourhood. Those that reject most candidates come first.
using Window = std::vector<std::array<int, 2>>;
/// All 24 pixels of the 5x5 neighbourhood, nearest first.
const Window& full_window();
/// Eight pixels: the diagonal neighbours and those two steps away along the axes.
const Window& sparse_window();

}  // namespace terrazzo
