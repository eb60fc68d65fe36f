#pragma once

#include <vector>

#include "core/synthesis/steps/element_packing.h"

namespace terrazzo {

/// Makes an element end where its neighbours begin: along each ray from its centre, what lies between its core and its
/// outline is squeezed or stretched until the outline meets the border of what belongs to it. Basic arithmetic only, so
/// every machine decides alike. Thread-safe.
class ElementWarp {
 public:
  /// Moves nothing.
  ElementWarp() = default;
  /// `placed`: which element of the packing.
  ElementWarp(const ElementShapes& shapes, const ElementPacking& packing, int placed);

  /// A place of the element, from its centre, in blocks.
  struct At {
    double x, y;
  };
  /// What is shown at `at`. Where neighbours meet as they should, `at` itself.
  At operator()(At at) const;

 private:
  /// Along a ray, in steps of one block along x and y together: where the outline is, and where it should be.
  struct Ray {
    double outline = 0, border = 0;
  };
  Ray ray(double angle) const;
  std::vector<Ray> rays_;  // all around; empty: nothing is moved
};

}  // namespace terrazzo
