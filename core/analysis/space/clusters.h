#pragma once

#include <cstdint>
#include <vector>

#include "core/analysis/space/planes.h"

namespace terrazzo {

/// Pixels sorted into groups of similar values.
struct Clusters {
  int count = 0;                 ///< at most what was asked for: fewer if there are not so many different values
  int channels = 0;              ///< values per centre
  std::vector<double> centres;   ///< count rows, ascending by first channel, then by the next ...
  std::vector<uint8_t> labels;   ///< per pixel the row of its centre
  std::vector<float> distances;  ///< per pixel the Euclidean distance to its centre
};

struct ClusterOptions {
  int count = 4;        ///< 1..256
  int iterations = 50;  ///< at most; ends when nothing changes
  uint64_t seed = 1;
};

/// k-means (Lloyd 1982) from greedy k-means++ seeds (Arthur & Vassilvitskii, k-means++: the advantages of careful
/// seeding, 2007: of several candidates the one that lowers the sum of squared distances most). Centres are learned
/// from at most 262144 of the pixels. Sums are taken in one fixed order: the same bits on every machine and for any
/// number of threads. Throws Cancelled.
Clusters find_clusters(const Planes& planes, const ClusterOptions& options, const Task& task);

}  // namespace terrazzo
