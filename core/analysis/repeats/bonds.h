#pragma once

#include "core/analysis/space/planes.h"
#include "core/base/task.h"
#include "core/exemplar/lattice.h"

namespace terrazzo {

/// The bond of known courses or columns: the lattice of rank 2 by which the joints across them repeat. Averaging across
/// a band makes joints visible in stronger grain. Returns `bands` if joints are irregular. Throws Cancelled.
Lattice bond_of(const Planes& planes, const Lattice& bands, const Task& task);

}  // namespace terrazzo
