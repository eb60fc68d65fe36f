#pragma once

#include "core/base/task.h"
#include "core/material/material.h"

namespace terrazzo {

/// Whether opposite borders of every map fit together: windows across them resemble the rest of the map about as much
/// as windows inside, and a lattice, if any, has whole cells. Throws Cancelled.
bool seems_to_tile(const Material& material, const Task& task);

}  // namespace terrazzo
