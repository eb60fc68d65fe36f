#pragma once

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <vector>

namespace terrazzo {

/// Disjoint sets of the numbers below a count (Tarjan 1975, with path halving). The smallest member represents each
/// set, whatever the order of joining.
class DisjointSets {
 public:
  explicit DisjointSets(size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0u); }

  uint32_t find(uint32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(uint32_t a, uint32_t b) {
    a = find(a);
    b = find(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<uint32_t> parent_;
};

}  // namespace terrazzo
