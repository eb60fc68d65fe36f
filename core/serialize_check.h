#pragma once

#include <vector>

#include "core/appearance.h"

namespace terrazzo {

/// Whether a pyramid read from a file can be worked with: each level half the one before, none too large or too small
/// for synthesis, bases that belong to the channels, and a lattice no larger than an exemplar can be. Throws
/// DamagedFile saying what is wrong.
void check_levels(const std::vector<AppearanceLevel>& levels, int channels, const Lattice& lattice);

}  // namespace terrazzo
