#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace terrazzo {

/// The minimum cut between a source and a sink in a graph of pixels with at most four neighbours each. Two search trees
/// grow from the terminals and are repaired after each augmenting path (Boykov & Kolmogorov, An experimental comparison
/// of min-cut/max-flow algorithms, 2004). Sides are numbered so that side (s + 2) % 4 leads back. Not thread-safe. Own
/// code since solvers for general graphs, such as Boost's, do not promise which of several equal cuts they find.
class GridCut {
 public:
  /// Begins a new graph.
  void reset(int nodes);
  /// Adds `cost` for assigning the node to the sink's side; a negative cost favours the sink's side.
  void prefer_source(int node, int64_t cost) { nodes_[size_t(node)].excess += cost; }
  /// Sets the cost, 0 to 2^30, of `node` on the source's side with `other`, its neighbour on side `side`, on the sink's
  /// side. Call once for each of the two directions of a pair.
  void join(int node, int side, int other, int64_t cost);
  /// Finds the minimum cut; among equal ones, the one with the fewest nodes on the source's side.
  void solve();
  bool on_source_side(int node) const { return nodes_[size_t(node)].tree == Tree::source; }

 private:
  enum class Tree : uint8_t { none, source, sink };
  static constexpr int16_t orphaned = -1, terminal = 4;
  struct Node {
    std::array<int32_t, 4> to{-1, -1, -1, -1};
    std::array<int32_t, 4> capacity{};
    int64_t excess = 0;    // above 0: what can still come from the source, below: go to the sink
    int32_t distance = 0;  // to the terminal in steps, when it was last looked at
    int32_t looked_at = 0;
    int16_t parent = orphaned;  // the side on which it is, or the terminal itself
    Tree tree = Tree::none;
    bool active = false;
  };
  /// The join between a node of the source's tree and one of the sink's.
  struct Join {
    int node = -1, side = 0;
  };

  Node& beside(const Node& n, int side) { return nodes_[size_t(n.to[size_t(side)])]; }
  int32_t& capacity(Node& n, int side, bool out);
  void activate(int node);
  Join grow(int node);
  void augment(const Join& join);
  int64_t least_on_way(int node);
  void send(int node, int64_t flow);
  void adopt_orphans();
  bool find_parent(Node& orphan);
  int distance(int node);
  void give_up(int node);

  std::vector<Node> nodes_;
  std::vector<int> active_, orphans_;
  int32_t time_ = 0;  // augmenting paths found so far
};

}  // namespace terrazzo
