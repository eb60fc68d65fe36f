#pragma once

#include <vector>

#include "core/image/image.h"

namespace terrazzo {

/// Light that changes slowly across a photographed base colour, such as a side that is farther from the lamp, or a
/// vignette. Homomorphic filtering (Oppenheim, Schafer & Stockham 1968): the logarithm of the picture is that of the
/// surface plus that of the light. Here the light is a sum of few slow functions of both coordinates, polynomials or,
/// where the picture wraps, waves. A surface has slow changes too, by chance: as much as in functions that are a little
/// quicker than light. So slow functions count only where they clearly exceed those, and where colours do not change
/// along with brightness. Immutable; thread-safe.
class SlowLight {
 public:
  /// No light.
  SlowLight() = default;
  /// `opacity`: what counts is where its first channel is at least 0.5, and likewise the colour's alpha; of the
  /// colour's size; may be null. `detail`: the greatest order of the functions, 1..most_detail: 1 is a slope, 2 also a
  /// vignette or a pool of light. Reads every pixel once. None for pictures with a side below least_side.
  SlowLight(const ImagePtr& color, const ImagePtr& opacity, int detail, bool wraps);

  static constexpr int most_detail = 4, least_side = 32;

  bool is_any() const { return !across_.empty(); }
  /// The brightest over the darkest place, at least 1.
  double contrast() const;
  /// The natural logarithm of the light at `count` pixels of a row, from column `x`; its mean over the picture is 0.
  void logarithms(int x, int y, int count, double* out) const;

 private:
  Size size_;
  size_t functions_ = 0;        ///< per axis
  std::vector<double> across_;  ///< for each column, the values of all functions
  std::vector<double> down_;    ///< for each row, the factors of those
};

}  // namespace terrazzo
