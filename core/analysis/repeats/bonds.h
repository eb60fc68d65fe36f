#pragma once

#include "core/analysis/space/planes.h"
#include "core/base/task.h"
#include "core/exemplar/lattice.h"

namespace terrazzo {

/// The bond of known courses or columns: the lattice of rank 2 by which the joints across them repeat. Averaged along a
/// band's breadth they stand out even of grain that is louder than they are. The bands themselves where joints lie
/// anyhow, as between headers and stretchers of all widths. Throws Cancelled.
Lattice bond_of(const Planes& planes, const Lattice& bands, const Task& task);

}  // namespace terrazzo
