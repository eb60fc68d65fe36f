#pragma once

#include <cstdint>

#include "core/synthesis/state/correction_level.h"
#include "core/synthesis/state/field.h"
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

/// Every second pixel of every second row: the pixels that one sub-pass of a correction corrects.
struct SubPass {
  SubPass() = default;  ///< none
  /// `wanted`: columns and rows of the field; `odd_x`, `odd_y`: 1 for odd positions of the plane, 0 for even ones.
  SubPass(const PlaneWindow& window, const Rect& wanted, int odd_x, int odd_y)
      : first_x(wanted.x + ((window.part.x + wanted.x + odd_x) & 1)),
        first_y(wanted.y + ((window.part.y + wanted.y + odd_y) & 1)),
        columns((wanted.right() - first_x + 1) / 2),
        rows((wanted.bottom() - first_y + 1) / 2) {}
  int x(int column) const { return first_x + 2 * column; }
  int y(int row) const { return first_y + 2 * row; }
  int first_x = 0, first_y = 0;
  int columns = 0, rows = 0;
};

/// Corrects a tile of a sub-pass's pixels into `out`, which holds all of the sub-pass. `tile`: columns and rows of the
/// sub-pass. Thread-safe as long as nobody changes the inputs; the same on every machine.
void correct_tile(const CorrectionInputs& inputs, const SubPass& part, const Rect& tile, ExemplarPixel* out);

}  // namespace terrazzo
