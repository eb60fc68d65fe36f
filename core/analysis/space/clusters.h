#pragma once

#include <cstdint>
#include <vector>

#include "core/analysis/space/planes.h"

namespace terrazzo {

/// Pixels grouped by similar values.
struct Clusters {
  int count = 0;                 ///< at most as asked for; fewer if there are fewer different values
  int channels = 0;              ///< values per centre
  std::vector<double> centres;   ///< count rows, in ascending lexicographic order
  std::vector<uint8_t> labels;   ///< per pixel the row of its centre
  std::vector<float> distances;  ///< per pixel the Euclidean distance to its centre
};

struct ClusterOptions {
  int count = 4;        ///< 1..256
  int iterations = 50;  ///< at most; ends when nothing changes
  uint64_t seed = 1;
};

/// k-means (Lloyd 1982) with greedy k-means++ seeding (Arthur & Vassilvitskii, k-means++: the advantages of careful
/// seeding, 2007). Centres are learnt from at most 262144 pixels. The same bits on every machine and for any number of
/// threads. Throws Cancelled.
Clusters find_clusters(const Planes& planes, const ClusterOptions& options, const Task& task);

}  // namespace terrazzo
