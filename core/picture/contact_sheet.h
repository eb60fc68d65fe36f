#pragma once

#include <string>
#include <vector>

#include "core/image/image.h"
#include "core/material/material.h"

namespace terrazzo {

/// Pictures in rows and columns, all at the same scale, with thin borders, as one 8-bit sRGB image at most `max_side`
/// pixels wide and high. Null pointers leave empty cells. Pixels are shown as stored (one channel as grey, a fourth
/// channel left out), clamped to [0, 1]. Large pictures are pulled strip by strip. Throws Error if there is no picture,
/// or `max_side` is too small to give each a pixel. `captions`: texts below the pictures, in the same rows and columns,
/// truncated if too long; may be empty.
ImagePtr contact_sheet(const std::vector<std::vector<ImagePtr>>& rows, int max_side,
                       const std::vector<std::vector<std::string>>& captions = {});

/// The exemplar beside a result: side by side for one map, else in two rows with the maps in columns; with captions.
ImagePtr comparison_sheet(const Material& exemplar, const Material& result, const std::vector<std::string>& maps,
                          int max_side);

}  // namespace terrazzo
