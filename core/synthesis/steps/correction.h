#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/task.h"
#include "core/synthesis/state/comparison_window.h"
#include "core/synthesis/state/correction_level.h"
#include "core/synthesis/state/field.h"
#include "core/synthesis/state/plane_window.h"
#include "core/synthesis/state/usage_penalty.h"

namespace terrazzo {

struct CorrectionPass {
  const Window* window = nullptr;
  uint32_t coherence = unit_factor;  ///< factor on the cost of candidates that continue a neighbour
  /// If not empty it replaces `coherence`: per output pixel, the factor on continuing the piece it is in.
  std::vector<uint32_t> piece_coherence{};
  int random_candidates = 0;
  uint64_t seed = 0;
  int pass = 0;
  Rect wanted;  ///< the columns and rows that have to be right after the pass; others are left undefined
};

/// How far from a pixel its correction reads in each sub-pass: the farthest ring searched for repeats.
inline constexpr int correction_reach = 6;
inline constexpr int sub_passes = 4;  ///< each corrects every second pixel of every second row

/// One correction pass (Lefebvre & Hoppe 2005, section 4.3): every pixel takes the best of its neighbours'
/// continuations, their k-coherent candidates and some random places. It runs as four sub-passes over interleaved
/// pixels, each of which reads what the one before has written: the result depends neither on the order of work nor on
/// which part of the plane the field holds. Throws Cancelled, and Error for
/// more candidates than the kernel takes.
void correct(Field& field, const CorrectionLevel& level, const CorrectionPass& pass, UsagePenalty& usage,
             const Task& task);

}  // namespace terrazzo
