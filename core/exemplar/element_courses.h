#pragma once

#include <vector>

#include "core/exemplar/elements.h"
#include "core/exemplar/lattice.h"

namespace terrazzo {

/// What a course may consist of, along it, and the course that each piece is of, across.
struct CoursePieces {
  std::vector<ExemplarSpan> pieces, bands;
};

/// Courses of an exemplar, of one height or of several, as its elements tell them.
struct ElementCourses {
  bool upright = false;  ///< they are columns
  /// Across: each course, from the middle of a joint that goes all along the exemplar to the next.
  std::vector<ExemplarSpan> bands;
  /// Of each of them, along it: what lies between two joints that go all across it. Without what reaches over several
  /// courses.
  std::vector<std::vector<ExemplarSpan>> pieces;

  bool empty() const { return bands.empty(); }
  /// Those of all courses that are as high as this one.
  CoursePieces pieces_for(const ExemplarSpan& band) const;
  /// As a lattice: one band as high, or as wide, as the exemplar. Rank 0 if empty.
  Lattice lattice(Size exemplar) const;
};

/// `tiles`: the exemplar does, and courses and pieces go on around its border; of one that does not, those that its
/// border cuts count only where few others are, on the right and below, up to there. Empty if joints go all along it
/// both ways or in no way, if there are fewer than two courses, or no pieces for one of them, or if joints go on from
/// course to course: then what lies side by side belongs together. Thread-safe.
ElementCourses element_courses(const Elements& elements, bool tiles);

/// Whether joints go all along an exemplar that tiles both ways: panels of all sizes in a frame. Thread-safe.
bool joints_cross(const Elements& elements);

}  // namespace terrazzo
