#pragma once

#include "core/base/geometry.h"
#include "core/base/task.h"
#include "core/exemplar/features.h"

namespace terrazzo {

/// An exemplar without borders whose tone is unlike all the rest: a vignette, the dirty foot of a wall, the verge of a
/// lawn. Every other part of it may show anywhere in a result, and such a border would come in patches. At most a
/// quarter of each side is left out, and no less than an eighth. Nothing of an exemplar that tiles, has cells or a
/// mask; of courses or columns only the ends are looked at, since one of them may lie along a border. Throws Cancelled.
struct Evenness {
  Rect part;  ///< what is left
  /// Whether what is left changes from one side to the other as a whole, and nothing keeps what it shows in its place:
  /// most of what differs between its parts differs from row to row, or column to column.
  bool changes_down = false, changes_across = false;
};
Evenness evenness(const Features& features, const Task& task);

}  // namespace terrazzo
