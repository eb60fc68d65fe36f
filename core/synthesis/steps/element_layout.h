#pragma once

#include "core/base/task.h"
#include "core/exemplar/appearance.h"
#include "core/synthesis/state/correction_level.h"
#include "core/synthesis/state/field.h"

namespace terrazzo {

/// Lays a result anew from whole elements of the exemplar: those that the field shows for the most part stay where they
/// are, the others give way to ones that fit the room (ElementPacking). Where two neighbours overlap or leave a gap,
/// the rims of both are squeezed or stretched until joints meet (ElementWarp). Kept pixels stay; elements that are kept
/// in part go on beyond. Throws Cancelled.
void lay_elements(Field& field, const CorrectionLevel& level, const Appearance& appearance, const Task& task);

/// Whether an exemplar has elements, and enough of them whole, to be laid. How sure they must be was asked where they
/// were found.
bool has_elements(const Appearance& appearance);

}  // namespace terrazzo
