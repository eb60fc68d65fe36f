#pragma once

#include <cstdint>

#include "core/analysis/courses/coursing.h"
#include "core/synthesis/steps/correction.h"

namespace terrazzo {

/// Lays the courses of a result anew so that bricks are whole: along each course that sequence of the exemplar's is
/// taken which is most like what the course shows, where going over from one part of the exemplar to another is cheap
/// in joints only (dynamic programming; Viterbi 1967). What is whole already stays. A pixel of the field stands for a
/// block of `block` x `block` pixels of the finest level, and the field must hold the whole plane. Nothing may be fixed
/// or steered. False, with nothing changed, if the exemplar has no courses, or a result that wraps would not meet its
/// own courses. The result does not depend on the number of threads. Throws Cancelled.
bool lay_courses(Field& field, int block, const CorrectionLevel& level, const Appearance& appearance,
                 const Coursing& coursing, const LatticePhase& phase, const Task& task);

}  // namespace terrazzo
