#pragma once

#include <cstdint>
#include <vector>

#include "core/base/geometry.h"
#include "core/synthesis/state/comparison_window.h"
#include "core/synthesis/state/cost_factor.h"

namespace terrazzo {

/// What the kernel takes at most.
inline constexpr int most_window_pixels = 24;  ///< those of full_window()
inline constexpr int most_random_candidates = 40;

struct CorrectionPass {
  const Window* window = nullptr;    ///< the pixels that are compared, at most most_window_pixels
  uint32_t coherence = unit_factor;  ///< factor on the cost of candidates that continue a neighbour, in unit_factor
  /// If not empty it replaces `coherence`: per output pixel, the factor on continuing the piece it is in.
  std::vector<uint32_t> piece_coherence{};
  int random_candidates = 0;  ///< per pixel, at most most_random_candidates
  uint64_t seed = 0;
  int pass = 0;  ///< its number on the level, from 0
  Rect wanted;   ///< the columns and rows that have to be right after the pass; others are left undefined
};

/// How far from a pixel its correction reads in each sub-pass: the farthest ring searched for repeats.
inline constexpr int correction_reach = 6;
inline constexpr int sub_passes = 4;  ///< each corrects every second pixel of every second row

}  // namespace terrazzo
