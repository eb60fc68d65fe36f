#pragma once

#include "core/base/task.h"
#include "core/exemplar/features.h"
#include "core/exemplar/streaks.h"

namespace terrazzo {

/// How an exemplar repeats, with its streaks: it can be shortened along an axis by as much as takes hardly any of its
/// variance away, in each of its parts, where the same across would take most of it. Courses or columns that streaks
/// make by chance are left out. No streaks if there is a mask, elements, a lattice of rank 2, one that is not sure, or
/// several parts. Throws Cancelled.
Repeats with_streaks(const Features& features, const Task& task);

}  // namespace terrazzo
