#pragma once

#include <cstdint>

#include "core/base/task.h"
#include "core/exemplar/appearance.h"
#include "core/synthesis/state/correction_level.h"
#include "core/synthesis/state/field.h"

namespace terrazzo {

/// What becomes of two neighbours that overlap or leave a gap.
enum class ElementRims : uint8_t {
  bent,         ///< both rims are squeezed or stretched until joints meet (ElementWarp)
  as_they_are,  ///< a pixel shows the element in which it lies deepest
};

/// Lays a result anew from whole elements of the exemplar: those that the field shows for the most part stay where they
/// are, the others give way to ones that fit the room (ElementPacking). Kept pixels stay; elements that are kept in
/// part go on beyond. Throws Cancelled.
void lay_elements(Field& field, const CorrectionLevel& level, const Appearance& appearance, ElementRims rims,
                  const Task& task);

/// Whether an exemplar has elements, and enough of them whole, to be laid. How sure they must be was asked where they
/// were found.
bool has_elements(const Appearance& appearance);

/// Whether elements lie about anyhow and their outlines are not sure, as of pebbles: some lie partly under others.
bool are_heaped(const Appearance& appearance);

}  // namespace terrazzo
