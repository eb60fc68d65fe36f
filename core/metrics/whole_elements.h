#pragma once

#include <cstdint>
#include <vector>

#include "core/base/task.h"
#include "core/exemplar/elements.h"
#include "core/exemplar/uv_map.h"

namespace terrazzo {

/// How a result shows the elements of its exemplar. Elements are parted by their joints: parts of the result that no
/// joint parts are one element.
struct ShownElements {
  int whole = 0;       ///< that show most of one of the exemplar's elements, and hardly anything else
  int all = 0;         ///< elements for which there is room, at the mean size of those of the exemplar
  int distinct = 0;    ///< different elements of the exemplar among the whole ones
  double missing = 0;  ///< share of the exemplar's area in elements that are not shown at all, 0..1

  /// Whether so few elements are whole that the result is not to be trusted. `heaped`: some lie under others, and need
  /// not be whole.
  bool are_broken(bool heaped) const;
  /// Whether so much of the exemplar is missing that the result looks like another material.
  bool lack_most() const;
};

/// Looks at a sample of the pixels, about twelve across an element's side. Elements that the result's border cuts are
/// left out, unless it wraps. `elements`: of the uv map's exemplar, at its size. Throws Cancelled.
ShownElements shown_elements(const UvMap& uv, const Elements& elements, const Task& task);

/// For each pixel of the result, row by row, 1 if it lies inside an element that is torn or melted together with
/// others, else 0: joints, too. Elements of one exemplar element that the result's border cuts are not torn. Takes and
/// throws the same.
std::vector<uint8_t> torn_elements(const UvMap& uv, const Elements& elements, const Task& task);

}  // namespace terrazzo
