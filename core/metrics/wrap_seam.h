#pragma once

#include "core/image/image.h"

namespace terrazzo {

/// Mean absolute difference across opposite borders (as if tiled), relative to that between neighbours inside. About 1
/// if the image tiles in that direction, higher if not. Pulls the image strip by strip.
struct WrapSeam {
  double x = 1;  ///< left against right border
  double y = 1;  ///< top against bottom
};
WrapSeam wrap_seam(const Image& image);

}  // namespace terrazzo
