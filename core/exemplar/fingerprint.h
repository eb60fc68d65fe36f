#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/base/geometry.h"
#include "core/base/hash.h"

namespace terrazzo {

/// Small copies of the channels that an exemplar was analysed from. They go with the index and the uv map, so that a
/// material can be told that is not the analysed one (core/analysis/space/likeness.h). Each is stretched to 0..255.
struct Fingerprint {
  struct Channel {
    std::string map;             ///< the map's name in its material
    int channel = 0;             ///< in analysis space
    std::vector<uint8_t> means;  ///< of cells.area() cells, row by row
  };
  Size cells;                     ///< into how many cells the exemplar is divided, at most `most_cells` a side
  std::vector<Channel> channels;  ///< those that are not of one value

  static constexpr int most_cells = 32;
  void add_to(Hasher& h) const;
};
using FingerprintPtr = std::shared_ptr<const Fingerprint>;

}  // namespace terrazzo
