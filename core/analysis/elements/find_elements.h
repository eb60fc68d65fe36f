#pragma once

#include "core/base/task.h"
#include "core/exemplar/elements.h"
#include "core/exemplar/features.h"

namespace terrazzo {

/// The certainty from which on elements are taken for such, unless another is asked for.
inline constexpr double sure_elements = 0.3;
/// The share of it that will do where there is no lattice: nothing else keeps stones whole there (experiments.md,
/// "heaped_elements").
inline constexpr double sure_without_lattice = 0.75;

/// Parts an exemplar into its elements: the picture is flooded from within them (catchment_basins) up to the joints,
/// which are the lines, dark or light, in whichever mix of channels tells them best. Says how sure it is; sand, grass
/// and rock come out below about 0.2. Null if nothing can be told apart. Throws Cancelled.
ElementsPtr find_elements(const Features& features, const Task& task);

}  // namespace terrazzo
