#pragma once

#include "core/analysis/space/appearance_space.h"
#include "core/analysis/space/k_coherence.h"
#include "core/analysis/space/weighting.h"
#include "core/base/hash.h"
#include "tests/run_node.h"

namespace terrazzo::test {

/// A little brick wall: courses of 8 pixels, bricks of 16, joints of 1, every brick with a shade of its own.
inline ImagePtr wall(Size size) {
  return make_image(
      size, 3,
      [](int x, int y, int c) {
        const int course = y / 8, shifted = x + (course % 2) * 8;
        if (y % 8 == 0 || shifted % 16 == 0) return 0.8f;
        const double shade = unit_double(random_bits(5, course, shifted / 16));
        const double speckle = unit_double(random_bits(6, x, y));
        return float(0.3 + 0.2 * shade + 0.05 * speckle - 0.1 * c);
      },
      Semantic::base_color, "srgb_texture");
}

/// Brushed metal: every row, or column, has streaks of its own, about 64 pixels long.
inline ImagePtr brushed(Size size, bool along_x = true) {
  constexpr double length = 64;
  return make_image(
      size, 3,
      [=](int x, int y, int c) {
        const int along = along_x ? x : y, row = along_x ? y : x;
        const double at = along / length + unit_double(random_bits(7, row));
        const auto begun = uint64_t(at);
        const auto shade = [row](uint64_t streak) { return unit_double(random_bits(8, row, streak)); };
        const double part = at - double(begun);
        return float(0.3 + 0.4 * ((1 - part) * shade(begun) + part * shade(begun + 1)) - 0.02 * c);
      },
      Semantic::base_color, "srgb_texture");
}

/// Features of an image as they are, without going through colour.
inline FeaturesPtr plain_features(const ImagePtr& image, bool wraps = false) {
  return Features::make(image->size(), {{image, std::vector<double>(image->channels(), 1.0)}}, wraps);
}

inline IndexPtr wall_index(Size size = {48, 40}, bool wraps = false) {
  return make_index(make_appearance(*plain_features(wall(size), wraps), {}, {}, Task()), 3, Task());
}

}  // namespace terrazzo::test
