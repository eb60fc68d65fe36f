#pragma once

#include <string>

#include "core/material/material.h"

namespace terrazzo {

/// The map of that name of the material, the i-th of several, its values meaning what those of a map described by
/// `first` mean: in its colour space, and its normal convention. Computed when pulled. Thread-safe. Throws Error about
/// "materials" if it is another kind of map, or has other channels.
ImagePtr adapted_map(const Material& material, size_t i, const std::string& name, const ImageInfo& first);

}  // namespace terrazzo
