#pragma once

namespace terrazzo {

/// How many points a leaf of NearestPoints holds side by side.
inline constexpr int leaf_points = 16;

/// The squared distances of a leaf's points from a query into `squared`, which has room for leaf_points. `values`: per
/// dimension, leaf_points numbers. False, and no distances, once all are beyond `limit`. Thread-safe; the same bits on
/// every machine.
bool leaf_distances(const float* values, const float* query, int dimensions, float limit, float* squared);

}  // namespace terrazzo
