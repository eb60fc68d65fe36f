#pragma once

#include <cstdint>
#include <vector>

#include "core/base/task.h"
#include "core/image/float_planes.h"

namespace terrazzo {

/// Patches are 7x7 samples with all channels, `step` pixels apart, numbered by their top left corners among all
/// positions where a whole patch fits, row by row.
inline constexpr int patch_side = 7;
using PatchList = std::vector<uint32_t>;

Size patch_positions(Size image, int step = 1);
inline int patch_values(const Planes& image) {
  return patch_side * patch_side * image.channels;
}
PatchList all_patches(Size image, int step = 1);
/// At most `count` different patches in random order; a pure function.
PatchList random_patches(Size image, size_t count, uint64_t seed, int step = 1);

/// An image that wraps, continued to the right and below so that a patch starts at every pixel; does not wrap itself.
Planes with_windows_across(const Planes& image, int step = 1);

/// An affine map of a patch to `outputs` numbers (a multiple of 8).
struct Projection {
  int inputs = 0;
  int outputs = 0;
  int step = 1;                ///< of the patches that it is made for
  std::vector<float> mean;     ///< inputs; subtracted first
  std::vector<float> weights;  ///< row major, inputs x outputs
};

/// Onto the patches' leading principal components, learnt from at most 20 000 patches. Throws Cancelled.
Projection principal_projection(const Planes& image, const PatchList& patches, int outputs, const Task& task,
                                int step = 1);
/// Random unit vectors, evenly spread over all directions.
Projection random_directions(int inputs, int outputs, uint64_t seed);

/// One row of projection.outputs numbers per patch. Throws Cancelled.
std::vector<float> project(const Planes& image, const PatchList& patches, const Projection& projection,
                           const Task& task);

}  // namespace terrazzo
