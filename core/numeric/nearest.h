#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "core/numeric/leaf_distances.h"

namespace terrazzo {

/// A kd-tree over points (Bentley 1975) with the bounded-error search of Arya & Mount (1998). Immutable once built;
/// searches are thread-safe. Nanoflann was fifteen times slower for 24-dimensional patches: it computes full distances
/// point by point, whereas these leaves process 16 points in parallel and stop early together.
class NearestPoints {
 public:
  struct Match {
    uint32_t index = 0;
    float squared = 0;  ///< the squared distance
  };
  static constexpr uint32_t nothing = ~0u;

  /// `points`: rows of `dimensions` numbers, at least one row.
  NearestPoints(const std::vector<float>& points, int dimensions);

  /// Finds a point at most 1 + slack times as far from the query as the nearest one. The first of several points at the
  /// same distance wins. `left_out`: excludes points by index; empty: none.
  Match find(const float* query, double slack, const std::function<bool(uint32_t)>& left_out = {}) const;

 private:
  static constexpr int leaf_size = leaf_points;
  struct Node {
    int axis = -1;       ///< -1: a leaf
    float low = 0;       ///< where the lower half ends, and
    float high = 0;      ///< where the upper half begins
    uint32_t child = 0;  ///< upper half's node (the lower half's is the next one), or the leaf's rank
  };
  struct Search;
  void build(const std::vector<float>& points, uint32_t* begin, uint32_t* end);
  void add_leaf(const std::vector<float>& points, const uint32_t* begin, const uint32_t* end);
  void visit(uint32_t node, float beyond, Search& search) const;
  void scan(uint32_t leaf, Search& search) const;

  int dimensions_;
  std::vector<Node> nodes_;
  std::vector<float> leaf_values_;      ///< per leaf and dimension, leaf_size numbers
  std::vector<uint32_t> leaf_indices_;  ///< per leaf, leaf_size
};

}  // namespace terrazzo
