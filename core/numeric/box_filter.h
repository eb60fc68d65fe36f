#pragma once

#include <vector>

#include "core/base/geometry.h"
#include "core/base/task.h"

namespace terrazzo {

/// A box filter along a line: weight 1 up to `reach` positions away and `end` one further, 0..1.
struct Box {
  int reach = 0;
  double end = 0;

  /// The extended box with this variance (Gwosdek, Grewenig, Bruhn & Weickert, Theoretical foundations of Gaussian
  /// convolution by extended box filtering, 2011). A few passes approximate a Gaussian.
  static Box of_variance(double variance);
  double sum() const { return 2 * reach + 1 + 2 * end; }
};

/// Applies the box `passes` times along each axis, in place, by running sums: the time does not depend on its size.
/// `pixels`: interleaved channels. Beyond a border the image wraps, or else border pixels repeat. Sums in a fixed
/// order: bit-exact on every machine. Parallel. Throws Cancelled.
void box_filter(std::vector<float>& pixels, Size size, int channels, const Box& box, int passes, bool wraps,
                const Task& task);

/// The mean around every pixel with triangular weights of `radius` pixels: a box of half that radius applied twice.
std::vector<float> local_mean(std::vector<float> pixels, Size size, int channels, int radius, bool wraps);

}  // namespace terrazzo
