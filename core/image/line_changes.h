#pragma once

#include "core/base/task.h"
#include "core/image/float_planes.h"

namespace terrazzo {

/// How much an image changes from line to line, in mean squares over all channels, the changes being averaged along
/// runs of a line of several lengths: where lines go on straight they stay, all else cancels out.
struct LineChanges {
  double single = 0;   ///< of single pixels
  double brief = 0;    ///< along a sixteenth of the shorter side
  double lasting = 0;  ///< along half of it
};

/// Those between rows, or columns. `side`: the shorter side that runs are measured by, of this image or the one that it
/// shows. Lines shorter than half of it have none. Throws Cancelled.
LineChanges line_changes(const Planes& image, bool rows, int side, const Task& task);

}  // namespace terrazzo
