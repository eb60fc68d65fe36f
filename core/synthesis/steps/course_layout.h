#pragma once

#include "core/analysis/courses/coursing.h"
#include "core/base/task.h"
#include "core/synthesis/state/correction_level.h"
#include "core/synthesis/state/field.h"

namespace terrazzo {

/// Lays the courses of a result anew so that bricks are whole. Each course becomes that sequence of runs of the
/// exemplar's courses which is most like what it shows, where cuts cost little in joints and much in bricks (dynamic
/// programming; Viterbi 1967). Bricks that are whole already stay. The field must hold the whole plane. There must be
/// no fixed pixels and no controls. False, with nothing changed, if the exemplar has no courses, or if the courses of a
/// result that wraps would not meet themselves. The result does not depend on the number of threads. Throws Cancelled.
bool lay_courses(Field& field, const CorrectionLevel& level, const Appearance& appearance, const Coursing& coursing,
                 const LatticePhase& phase, const Task& task);

}  // namespace terrazzo
