#pragma once

#include "core/base/task.h"
#include "core/exemplar/elements.h"
#include "core/exemplar/uv_map.h"
#include "core/image/image.h"

namespace terrazzo {

/// A result's elements, and how many of them are put together from several of the exemplar's. One counts as whole if
/// 85 % of its area come from one element in one piece; a piece may be bent by a pixel or two from one pixel to the
/// next.
struct HybridElements {
  int elements = 0;      ///< of the result that are not cut by its border
  double by_area = 0;    ///< the share of their area that hybrids take up, 0..1
  double by_number = 0;  ///< the share of them that are hybrids, 0..1
};

/// The elements that a picture tells apart by its first channel: pixels of one value are one element. `size`: the
/// exemplar's, at which the picture is read by nearest samples. Throws Error about "labels" if there are more than
/// most_elements values; Cancelled.
Elements labelled_elements(const ImagePtr& labels, Size size, const Task& task);

/// Where the result's elements lie is told by how deep in an element of the exemplar each pixel lies: between two
/// elements there is a line where none is deep, and where there is none, two that touch are one. `elements`: of the
/// exemplar that the uv map was made from, at its size. Throws Error about "labels" if it has another size; Cancelled.
HybridElements hybrid_elements(const UvMap& uv, const Elements& elements, const Task& task);

}  // namespace terrazzo
