#pragma once

#include "core/image/float_planes.h"

/// Small textures to measure metrics with, and ways to spoil them.
namespace terrazzo::test {

/// Rows of staggered bricks with grain: one channel in [0, 1]. The seed changes every brick's shade and the grain, so
/// that another seed is another sample of the same texture.
Planes bricks(Size size, uint64_t seed);
/// Round spots on a grainy ground: another texture.
Planes spots(Size size, uint64_t seed);

Planes tiled(const Planes& exemplar, Size size);
/// Every pixel from a random place.
Planes shuffled(const Planes& image, uint64_t seed);
/// Blocks from random places, side by side.
Planes random_blocks(const Planes& exemplar, Size size, int block, uint64_t seed);

}  // namespace terrazzo::test
