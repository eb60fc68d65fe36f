#pragma once

#include <cstdint>

#include "core/base/geometry.h"
#include "core/synthesis/state/correction_level.h"
#include "core/synthesis/state/field.h"
#include "core/synthesis/state/sub_pass.h"
#include "core/synthesis/state/usage_penalty.h"
#include "core/synthesis/steps/correction_pass.h"

/// The inner loop of correction, compiled for several instruction sets.
namespace terrazzo {

/// What all tiles of a sub-pass share. Borrows everything.
struct CorrectionInputs {
  const Field& field;
  const CorrectionLevel& level;
  const CorrectionPass& pass;  ///< its window and its random candidates are at most as many as the constants say
  const UsagePenalty& usage;
  uint32_t repeat_penalty = 0;  ///< in unit_factor: what each repeat near by adds to a candidate's cost
};

/// Corrects a tile of a sub-pass's pixels into `out`, which holds all of the sub-pass. `tile`: columns and rows of the
/// sub-pass. Thread-safe as long as nobody changes the inputs; the same on every machine.
void correct_tile(const CorrectionInputs& inputs, const SubPass& part, const Rect& tile, ExemplarPixel* out);

}  // namespace terrazzo
