#pragma once

#include "core/exemplar/appearance.h"
#include "core/synthesis/state/correction_level.h"
#include "core/synthesis/state/field.h"

namespace terrazzo {

/// Gives every element of a lattice that the field shows the rest of itself, up to its rim, those first of which it
/// shows most: no tile is put together from several. Joints stay as they are; seams find their way along them. Kept
/// pixels stay.
void complete_elements(Field& field, const CorrectionLevel& level, const Appearance& appearance);

}  // namespace terrazzo
