#include "core/numeric/grid_cut.h"

#include <algorithm>
#include <limits>

namespace terrazzo {

namespace {

constexpr int out_of_reach = std::numeric_limits<int>::max();

constexpr int back(int side) {
  return (side + 2) % 4;
}

}  // namespace

void GridCut::reset(int nodes) {
  nodes_.assign(size_t(nodes), {});
}

void GridCut::join(int node, int side, int other, int64_t cost) {
  Node& n = nodes_[size_t(node)];
  n.to[size_t(side)] = other;
  n.capacity[size_t(side)] = int32_t(cost);
}

void GridCut::solve() {
  active_.clear();
  time_ = 0;
  for (size_t i = 0; i < nodes_.size(); i++) {
    Node& n = nodes_[i];
    if (n.excess == 0) continue;
    n.tree = n.excess > 0 ? Tree::source : Tree::sink;
    n.parent = terminal;
    n.distance = 1;
    activate(int(i));
  }
  for (size_t next = 0; next < active_.size();) {
    const int node = active_[next++];  // others may be added meanwhile
    while (nodes_[size_t(node)].tree != Tree::none) {
      const Join join = grow(node);
      if (join.node < 0) break;
      time_++;
      augment(join);
      adopt_orphans();
    }
    nodes_[size_t(node)].active = false;
  }
}

/// The residual capacity of the join on that side, out of the node or into it.
int32_t& GridCut::capacity(Node& n, int side, bool out) {
  return out ? n.capacity[size_t(side)] : beside(n, side).capacity[size_t(back(side))];
}

void GridCut::activate(int node) {
  if (nodes_[size_t(node)].active) return;
  nodes_[size_t(node)].active = true;
  active_.push_back(node);
}

/// Adds free neighbours to the tree until it meets a node of the other tree.
GridCut::Join GridCut::grow(int node) {
  Node& n = nodes_[size_t(node)];
  for (int side = 0; side < 4; side++) {
    if (n.to[size_t(side)] < 0 || capacity(n, side, n.tree == Tree::source) <= 0) continue;
    Node& m = beside(n, side);
    if (m.tree == Tree::none) {
      m.tree = n.tree;
      activate(n.to[size_t(side)]);
    } else if (m.tree != n.tree) {
      return n.tree == Tree::source ? Join{node, side} : Join{n.to[size_t(side)], back(side)};
    } else if (m.looked_at > n.looked_at || m.distance <= n.distance + 1) {
      continue;  // its path to the terminal is no longer than one through this node
    }
    m.parent = int16_t(back(side));
    m.distance = n.distance + 1;
    m.looked_at = n.looked_at;
  }
  return {};
}

/// Sends as much flow as fits along the path that the join completes.
void GridCut::augment(const Join& join) {
  Node& n = nodes_[size_t(join.node)];
  const int other = n.to[size_t(join.side)];
  const int64_t flow = std::min({int64_t{n.capacity[size_t(join.side)]}, least_on_way(join.node), least_on_way(other)});
  n.capacity[size_t(join.side)] -= int32_t(flow);
  beside(n, join.side).capacity[size_t(back(join.side))] += int32_t(flow);
  send(join.node, flow);
  send(other, flow);
}

/// The residual capacity of the path between a node and its terminal.
int64_t GridCut::least_on_way(int node) {
  int64_t least = std::numeric_limits<int64_t>::max();
  Node* n = &nodes_[size_t(node)];
  const bool towards_sink = n->tree == Tree::sink;
  for (; n->parent != terminal; n = &beside(*n, n->parent))
    least = std::min(least, int64_t{capacity(*n, n->parent, towards_sink)});
  return std::min(least, towards_sink ? -n->excess : n->excess);
}

/// Sends flow between a node and its terminal. Nodes whose edge to their parent is saturated become orphans.
void GridCut::send(int node, int64_t flow) {
  Node* n = &nodes_[size_t(node)];
  const bool towards_sink = n->tree == Tree::sink;
  const auto orphan = [&](Node& m) {
    m.parent = orphaned;
    orphans_.push_back(int(&m - nodes_.data()));
  };
  while (n->parent != terminal) {
    const int side = n->parent;
    Node& parent = beside(*n, side);
    capacity(*n, side, !towards_sink) += int32_t(flow);
    int32_t& left = capacity(*n, side, towards_sink);
    left -= int32_t(flow);
    if (left == 0) orphan(*n);
    n = &parent;
  }
  n->excess += towards_sink ? flow : -flow;
  if (n->excess == 0) orphan(*n);
}

void GridCut::adopt_orphans() {
  for (size_t next = 0; next < orphans_.size();) {
    const int node = orphans_[next++];
    if (!find_parent(nodes_[size_t(node)])) give_up(node);
  }
  orphans_.clear();
}

/// Makes the neighbour nearest to the terminal the orphan's parent, among those of its tree that are still connected to
/// the terminal. False if there is none.
bool GridCut::find_parent(Node& orphan) {
  int least = out_of_reach;
  int16_t parent = orphaned;
  for (int side = 0; side < 4; side++) {
    if (orphan.to[size_t(side)] < 0 || beside(orphan, side).tree != orphan.tree ||
        capacity(orphan, side, orphan.tree == Tree::sink) <= 0)
      continue;
    const int found = distance(orphan.to[size_t(side)]);
    if (found >= least) continue;
    least = found;
    parent = int16_t(side);
  }
  if (parent == orphaned) return false;
  orphan.parent = parent;
  orphan.distance = least + 1;
  orphan.looked_at = time_;
  return true;
}

/// The number of steps to the terminal; cached in all nodes on the path.
int GridCut::distance(int node) {
  int steps = 0;
  Node* n = &nodes_[size_t(node)];
  for (; n->looked_at != time_; n = &beside(*n, n->parent), steps++) {
    if (n->parent == orphaned) return out_of_reach;
    if (n->parent != terminal) continue;
    n->distance = 1;
    n->looked_at = time_;
    break;
  }
  const int found = n->distance + steps;
  int left = found;
  for (n = &nodes_[size_t(node)]; n->looked_at != time_; n = &beside(*n, n->parent)) {
    n->distance = left--;
    n->looked_at = time_;
  }
  return found;
}

/// Makes the orphan a free node and its children orphans.
void GridCut::give_up(int node) {
  Node& n = nodes_[size_t(node)];
  for (int side = 0; side < 4; side++) {
    if (n.to[size_t(side)] < 0) continue;
    Node& m = beside(n, side);
    if (m.tree != n.tree) continue;
    if (capacity(n, side, n.tree == Tree::sink) > 0) activate(n.to[size_t(side)]);
    if (m.parent != back(side)) continue;
    m.parent = orphaned;
    orphans_.push_back(n.to[size_t(side)]);
  }
  n.tree = Tree::none;
}

}  // namespace terrazzo
