#pragma once

#include "core/image/image.h"

namespace terrazzo {

/// The mean absolute difference between opposite border pixels (neighbours once the image is tiled) over that between
/// neighbours inside. About 1 if the image tiles in that direction, more if it does not. Pulls the image strip by
/// strip.
struct WrapSeam {
  double x = 1;  ///< left against right border
  double y = 1;  ///< top against bottom
};
WrapSeam wrap_seam(const Image& image);

}  // namespace terrazzo
