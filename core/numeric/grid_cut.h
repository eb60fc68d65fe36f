#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace terrazzo {

/// The cheapest cut that separates a source from a sink, in a graph of pixels that are joined to at most four others
/// (blocking flows along shortest ways, Dinic 1970). Sides are numbered so that side (s + 2) % 4 leads back. Not
/// thread-safe.
class GridCut {
 public:
  /// Begins a new graph.
  void reset(int nodes);
  /// Makes a node's being on the sink's side cost more (that much less, if negative) than its being on the source's.
  void prefer_source(int node, int64_t cost) { nodes_[size_t(node)].excess += cost; }
  /// What it costs that `node` is on the source's side and `other`, which lies on its side `side`, is not. Once a pair
  /// and direction; both directions of a pair must be given.
  void join(int node, int side, int other, int64_t cost);
  /// Finds the cut. Of several that cost the same, the one with the fewest nodes on the source's side.
  void solve();
  bool on_source_side(int node) const { return nodes_[size_t(node)].distance > 0; }

 private:
  struct Node {
    std::array<int, 4> to{-1, -1, -1, -1};
    std::array<int64_t, 4> capacity{};
    int64_t excess = 0;  // above 0: what can still come from the source, below: go to the sink
    int distance = 0;    // to the sink in steps, in the end from the source; 0: out of reach
    int side = 0;        // the first that may still lead nearer to the sink
  };
  bool find_distances();
  bool push_from(int start);
  void find_source_side();

  std::vector<Node> nodes_;
  std::vector<int> queue_;
  std::vector<std::array<int, 2>> way_;  // nodes and the sides they are left by
};

}  // namespace terrazzo
