#pragma once

#include "core/exemplar/lattice.h"

namespace terrazzo {

/// The size near `size`, more than half of it and at most an eighth larger, at which a result on this lattice wraps
/// best along the given axes. The deviation in size is weighed against the distortion of cells. Cells may be distorted
/// by `slack` pixels along each side, plus the side's growth.
Size best_wrapping_size(const Lattice& lattice, Size size, bool wraps_x, bool wraps_y, Size slack);

}  // namespace terrazzo
