#pragma once

#include <vector>

#include "core/exemplar/appearance.h"

namespace terrazzo {

/// Throws DamagedFile(otherwise) unless the condition holds.
void require_sound(bool condition, const char* otherwise);
/// Validates a pyramid read from a file: each level half the size of the one before, none too large or too small for
/// synthesis, and bases that match the channels. Throws DamagedFile.
void check_levels(const std::vector<AppearanceLevel>& levels, int channels);
/// The same for the lattices of an exemplar: none larger than an exemplar can be, parts inside it.
void check_repeats(const Repeats& repeats, Size exemplar);

}  // namespace terrazzo
