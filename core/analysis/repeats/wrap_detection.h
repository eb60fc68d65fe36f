#pragma once

#include "core/base/task.h"
#include "core/material/material.h"

/// Whether an image or an exemplar repeats without a seam, from what it shows. `mask`, of the same aspect ratio at any
/// size: what counts is where its first channel exceeds 0.5; null: everything. If it leaves too little of the borders,
/// the answer is no. Both throw Cancelled. Thread-safe.
namespace terrazzo {

/// Whether opposite borders of every map fit together: windows across them resemble the rest of the map about as much
/// as windows inside, and neighbouring pixels are alike at all. Everything is pulled into memory.
bool borders_meet(const Material& material, const Task& task);

/// Whether borders fit together, and a lattice, if any, has whole cells.
bool seems_to_tile(const Material& material, const Task& task, const ImagePtr& mask = nullptr);

}  // namespace terrazzo
