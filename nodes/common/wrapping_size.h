#pragma once

#include "core/exemplar/lattice.h"

namespace terrazzo {

/// The size near `size`, over half of it and at most an eighth larger, with which a result on that lattice wraps best
/// along those axes: a size far off is weighed against cells that must be bent. They are bent within `give`, pixels
/// along each side, and what a side grows by.
Size best_wrapping_size(const Lattice& lattice, Size size, bool wraps_x, bool wraps_y, Size give);

}  // namespace terrazzo
