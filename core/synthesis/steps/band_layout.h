#pragma once

#include <cstdint>
#include <vector>

#include "core/base/task.h"
#include "core/exemplar/appearance.h"
#include "core/exemplar/element_courses.h"
#include "core/synthesis/state/correction_level.h"
#include "core/synthesis/state/field.h"
#include "core/synthesis/state/plane_window.h"

namespace terrazzo {

/// In which order a result shows the courses of its exemplar: see SpanOrder. Empty if `courses` are. Thread-safe.
std::vector<ShownSpan> bands_of(const ElementCourses& courses, Size exemplar, const Plane& result,
                                const ExistingPixels& kept, uint64_t bits);

/// Lays these bands: each is a random sequence of what lies between the joints of all that are as high, whole and
/// rigid, or goes on with what is kept. All pieces come about as often; joints seldom meet those of the band before.
/// The field must hold the whole plane; there must be no controls. The result does not depend on the number of threads.
/// Throws Cancelled.
void lay_bands(Field& field, const CorrectionLevel& level, const Appearance& appearance, const ElementCourses& courses,
               const std::vector<ShownSpan>& bands, uint64_t bits, const Task& task);

}  // namespace terrazzo
