#pragma once

#include "core/base/task.h"
#include "core/exemplar/elements.h"
#include "core/exemplar/uv_map.h"
#include "core/image/image.h"

namespace terrazzo {

/// A result's elements, and how many of them combine several elements of the exemplar. An element counts as whole if 85
/// % of its area comes from one element in one connected piece; within a piece, offsets may change by a pixel or two
/// between neighbours.
struct HybridElements {
  int elements = 0;      ///< elements of the result not cut by its border
  double by_area = 0;    ///< share of hybrids by area, 0..1
  double by_number = 0;  ///< share of hybrids by number, 0..1
};

/// The elements in a label image: pixels with equal values in its first channel form one element. `size`: the
/// exemplar's size, to which the image is resampled by nearest neighbour. Throws Error about "labels" if there are more
/// than most_elements values; Cancelled.
Elements labelled_elements(const ImagePtr& labels, Size size, const Task& task);

/// Finds the result's elements by each pixel's depth inside an exemplar element: shallow pixels separate elements, and
/// elements without such a boundary count as one. `elements`: of the uv map's exemplar, at its size. Throws Error about
/// "labels" if it has another size; Cancelled.
HybridElements hybrid_elements(const UvMap& uv, const Elements& elements, const Task& task);

}  // namespace terrazzo
