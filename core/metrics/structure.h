#pragma once

#include "core/base/task.h"
#include "core/image/float_planes.h"

namespace terrazzo {

/// The windows that are compared: 7x7 samples, `step` pixels apart, on level `level` of the pyramid.
struct StructureWindow {
  int level = 0;
  int step = 1;
  int side() const;  ///< in pixels of the image itself
};

/// The largest such window that is at most half as wide as a typical element and a quarter as wide as the exemplar:
/// mostly a third to a half of an element, and never less than 7 pixels. `element`: its side in pixels.
StructureWindow structure_window(double element, Size exemplar);

/// The share of the output's windows, 0..1, whose structure does not occur in the exemplar: joints that end inside a
/// stone, chevrons with diamonds instead of points, courses that jog. Windows hold the structure tensor (Bigun &
/// Granlund 1987) of all channels together (Di Zenzo 1986), smoothed to the distance of their samples, as strength and
/// doubled angle; strength saturates, so that a strong edge counts little more than a normal one. A window is foreign
/// if it is farther from the nearest one of the exemplar (coherence, Simakov et al. 2008) than 95 % of the exemplar's
/// own windows are from the nearest one that does not overlap them. So another sample of the same texture scores about
/// 0.05; copies score less.
///
/// `exemplar` and `output`: one level of their pyramids. Windows of an exemplar that wraps go on around its border.
/// Throws Cancelled.
double foreign_structure(const Planes& exemplar, const Planes& output, int step, const Task& task);

}  // namespace terrazzo
