#include "core/numeric/grid_cut.h"

#include <algorithm>

namespace terrazzo {

void GridCut::reset(int nodes) {
  nodes_.assign(size_t(nodes), {});
}

void GridCut::join(int node, int side, int other, int64_t cost) {
  Node& n = nodes_[size_t(node)];
  n.to[size_t(side)] = other;
  n.capacity[size_t(side)] = cost;
}

void GridCut::solve() {
  while (find_distances())
    for (size_t n = 0; n < nodes_.size(); n++)
      while (nodes_[n].excess > 0 && nodes_[n].distance > 0 && push_from(int(n))) {
      }
  find_source_side();
}

/// Whether the sink can be reached from the source.
bool GridCut::find_distances() {
  queue_.clear();
  for (size_t n = 0; n < nodes_.size(); n++) {
    nodes_[n].distance = nodes_[n].excess < 0 ? 1 : 0;
    nodes_[n].side = 0;
    if (nodes_[n].distance > 0) queue_.push_back(int(n));
  }
  bool reached = false;
  for (size_t i = 0; i < queue_.size(); i++) {
    const Node& n = nodes_[size_t(queue_[i])];
    for (size_t s = 0; s < 4; s++) {
      if (n.to[s] < 0) continue;
      Node& before = nodes_[size_t(n.to[s])];
      if (before.distance > 0 || before.capacity[(s + 2) % 4] <= 0) continue;
      before.distance = n.distance + 1;
      reached |= before.excess > 0;
      queue_.push_back(n.to[s]);
    }
  }
  return reached;
}

/// Lets as much flow as one shortest way takes. False if none is left from here.
bool GridCut::push_from(int start) {
  way_.clear();
  int at = start;
  while (nodes_[size_t(at)].excess >= 0) {
    Node& n = nodes_[size_t(at)];
    const auto leads_nearer = [&](int s) {
      return n.to[size_t(s)] >= 0 && n.capacity[size_t(s)] > 0 &&
             nodes_[size_t(n.to[size_t(s)])].distance == n.distance - 1;
    };
    while (n.side < 4 && (n.distance <= 1 || !leads_nearer(n.side))) n.side++;
    if (n.side < 4) {
      way_.push_back({at, n.side});
      at = n.to[size_t(n.side)];
      continue;
    }
    if (way_.empty()) return false;
    at = way_.back()[0];
    way_.pop_back();
    nodes_[size_t(at)].side++;
  }
  int64_t flow = std::min(nodes_[size_t(start)].excess, -nodes_[size_t(at)].excess);
  for (const auto& [n, s] : way_) flow = std::min(flow, nodes_[size_t(n)].capacity[size_t(s)]);
  for (const auto& [n, s] : way_) {
    nodes_[size_t(n)].capacity[size_t(s)] -= flow;
    nodes_[size_t(nodes_[size_t(n)].to[size_t(s)])].capacity[size_t(s + 2) % 4] += flow;
  }
  nodes_[size_t(start)].excess -= flow;
  nodes_[size_t(at)].excess += flow;
  return true;
}

void GridCut::find_source_side() {
  queue_.clear();
  for (size_t n = 0; n < nodes_.size(); n++) {
    nodes_[n].distance = nodes_[n].excess > 0 ? 1 : 0;
    if (nodes_[n].distance > 0) queue_.push_back(int(n));
  }
  for (size_t i = 0; i < queue_.size(); i++) {
    const Node& n = nodes_[size_t(queue_[i])];
    for (size_t s = 0; s < 4; s++)
      if (n.to[s] >= 0 && n.capacity[s] > 0 && nodes_[size_t(n.to[s])].distance == 0) {
        nodes_[size_t(n.to[s])].distance = n.distance + 1;
        queue_.push_back(n.to[s]);
      }
  }
}

}  // namespace terrazzo
