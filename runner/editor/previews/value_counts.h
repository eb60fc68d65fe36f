#pragma once

#include <cstdint>
#include <vector>

#include "core/image/image.h"

namespace terrazzo {

/// How often an image has which values.
struct ValueCounts {
  /// The first bin begins at `low`, the last ends at `high`; they cover [0, 1] and all values.
  double low = 0, high = 1;
  std::vector<std::vector<int64_t>> counts;  ///< by channel and bin; values that are not finite are left out
};

/// Of a large image only some rows, evenly spaced, are looked at. `bins` >= 1. Throws Error as reading pixels does.
ValueCounts value_counts(const Image& image, int bins);

}  // namespace terrazzo
