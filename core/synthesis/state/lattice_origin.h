#pragma once

#include "core/exemplar/lattice.h"
#include "core/synthesis/state/fixed_pixels.h"

/// Where a result's lattice starts: the position, in pixels of the finest level, at which the exemplar's first pixel is
/// in phase.
namespace terrazzo {

/// A random one, of random bits. Whole pixels, so that drawn patterns stay exact.
Vector2d random_lattice_origin(const Lattice& lattice, uint64_t bits);

/// The one that most of the kept pixels are in phase with, for a result of that size. Of pixels that always stay, or of
/// all that are kept if none does.
Vector2d lattice_origin(const Lattice& lattice, const ExistingPixels& kept, Size size);

}  // namespace terrazzo
