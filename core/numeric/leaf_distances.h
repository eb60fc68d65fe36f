#pragma once

namespace terrazzo {

/// The number of points in a leaf of NearestPoints.
inline constexpr int leaf_points = 16;

/// Computes the squared distances of a leaf's points from a query into `squared`, which has room for leaf_points.
/// `values`: leaf_points numbers per dimension. Returns false, without distances, once all exceed `limit`. Thread-safe;
/// bit-exact on every machine.
bool leaf_distances(const float* values, const float* query, int dimensions, float limit, float* squared);

}  // namespace terrazzo
