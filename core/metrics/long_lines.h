#pragma once

#include "core/base/task.h"
#include "core/exemplar/appearance.h"
#include "core/exemplar/uv_map.h"

namespace terrazzo {

/// How a result shows the long straight lines of its exemplar along one axis: joints, edges of panels and boards. The
/// change across a line is averaged along half of the exemplar: what goes on straight stays, all else cancels out.
struct LongLines {
  double share = 0;  ///< of all changes of the exemplar, along both axes, that stay
  double kept = 1;   ///< what stays in the result over what does in the exemplar, short lines in both being alike; 1
                     ///< of a share that is too small to be missed

  /// Whether the exemplar has such lines, and most of them are broken.
  bool are_broken() const;
};

/// Those along the axis of which most are broken, or else of which the exemplar has most. Looks at no more than twice
/// the exemplar's side of the result, from its top left corner. Where a mask leaves no rectangle of
/// the exemplar, there are none. Throws Cancelled.
LongLines long_lines(const UvMap& uv, const Appearance& appearance, const Task& task);

}  // namespace terrazzo
