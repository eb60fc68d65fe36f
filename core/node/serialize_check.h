#pragma once

#include <vector>

#include "core/exemplar/appearance.h"

namespace terrazzo {

/// Whether a pyramid read from a file can be worked with: each level half the one before, none too large or too small
/// for synthesis, and bases that belong to the channels. Throws DamagedFile saying what is wrong.
void check_levels(const std::vector<AppearanceLevel>& levels, int channels);
/// The same of how an exemplar of a known size repeats: no lattice larger than an exemplar can be, parts inside it.
void check_repeats(const Repeats& repeats, Size exemplar);

}  // namespace terrazzo
