#pragma once

#include <string>

#include "core/material/material.h"

namespace terrazzo {

/// The map `name` of the i-th of several materials, converted to the colour space and normal convention of `first`.
/// Computed when pulled. Thread-safe. Throws Error about "materials" if semantic or channels differ.
ImagePtr adapted_map(const Material& material, size_t i, const std::string& name, const ImageInfo& first);

}  // namespace terrazzo
