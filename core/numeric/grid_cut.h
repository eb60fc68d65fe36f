#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace terrazzo {

/// The cheapest cut that separates a source from a sink, in a graph of pixels that are joined to at most four others.
/// Two search trees grow from the terminals and are mended after each way that is found (Boykov & Kolmogorov, An
/// experimental comparison of min-cut/max-flow algorithms, 2004). Sides are numbered so that side (s + 2) % 4 leads
/// back. Not thread-safe.
class GridCut {
 public:
  /// Begins a new graph.
  void reset(int nodes);
  /// Makes a node's being on the sink's side cost more (that much less, if negative) than its being on the source's.
  void prefer_source(int node, int64_t cost) { nodes_[size_t(node)].excess += cost; }
  /// What it costs that `node` is on the source's side and `other`, which lies on its side `side`, is not: from 0 to
  /// 2^30. Once a pair and direction; both directions of a pair must be given.
  void join(int node, int side, int other, int64_t cost);
  /// Finds the cut. Of several that cost the same, the one with the fewest nodes on the source's side.
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
  int32_t time_ = 0;  // ways found so far
};

}  // namespace terrazzo
