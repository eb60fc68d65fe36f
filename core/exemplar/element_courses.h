#pragma once

#include <vector>

#include "core/exemplar/elements.h"
#include "core/exemplar/lattice.h"

namespace terrazzo {

/// Courses of different heights that an exemplar which tiles has once each, as its elements tell them.
struct ElementCourses {
  bool upright = false;      ///< they are columns
  std::vector<double> beds;  ///< the middles of joints that go all along the exemplar; pixels across, ascending
  /// Of the course from each bed to the next, the last around the border: the middles of joints that go all across it;
  /// pixels along it, ascending.
  std::vector<std::vector<double>> joints;

  bool empty() const { return beds.empty(); }
  /// As a lattice: one band as high, or as wide, as the exemplar. Rank 0 if empty.
  Lattice lattice(Size exemplar) const;
};

/// Of an exemplar that tiles. Empty if joints go all along it both ways, in no way or only once, if fewer than two go
/// across one of the courses, or if those go on from course to course: then what lies side by side belongs together.
/// Thread-safe.
ElementCourses element_courses(const Elements& elements);

}  // namespace terrazzo
