#include "core/numeric/nearest.h"

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>
#include <stdexcept>

#include "core/numeric/leaf_distances.h"

namespace terrazzo {

struct NearestPoints::Search {
  const float* query;
  std::vector<float> offsets;  ///< per axis, from the query to the cell being visited
  float tightness;             ///< (1 + slack) squared
  const std::function<bool(uint32_t)>& left_out;
  Match best{nothing, std::numeric_limits<float>::max()};
};

NearestPoints::NearestPoints(const std::vector<float>& points, int dimensions) : dimensions_(dimensions) {
  if (points.empty()) throw std::logic_error("a search needs points");
  std::vector<uint32_t> order(points.size() / dimensions);
  std::iota(order.begin(), order.end(), 0u);
  build(points, order.data(), order.data() + order.size());
}

void NearestPoints::build(const std::vector<float>& points, uint32_t* begin, uint32_t* end) {
  const uint32_t self = uint32_t(nodes_.size());
  nodes_.emplace_back();
  if (end - begin <= leaf_size) {
    nodes_[self].child = uint32_t(leaf_indices_.size() / leaf_size);
    add_leaf(points, begin, end);
    return;
  }
  const auto value = [&](uint32_t i, int axis) { return points[size_t(i) * dimensions_ + axis]; };
  std::vector<float> low(dimensions_, std::numeric_limits<float>::max());
  std::vector<float> high(dimensions_, std::numeric_limits<float>::lowest());
  for (const uint32_t* i = begin; i < end; i++)
    for (int k = 0; k < dimensions_; k++) {
      low[k] = std::min(low[k], value(*i, k));
      high[k] = std::max(high[k], value(*i, k));
    }
  int axis = 0;
  for (int k = 1; k < dimensions_; k++)
    if (high[k] - low[k] > high[axis] - low[axis]) axis = k;
  uint32_t* middle = begin + (end - begin) / 2;
  // Ties are ordered by index, so that the halves do not depend on how the standard library selects.
  std::nth_element(begin, middle, end, [&](uint32_t a, uint32_t b) {
    const float va = value(a, axis), vb = value(b, axis);
    return va < vb || (va == vb && a < b);
  });
  float below = low[axis];
  for (const uint32_t* i = begin; i < middle; i++) below = std::max(below, value(*i, axis));
  nodes_[self].axis = axis;
  nodes_[self].low = below;
  nodes_[self].high = value(*middle, axis);
  build(points, begin, middle);
  nodes_[self].child = uint32_t(nodes_.size());
  build(points, middle, end);
}

void NearestPoints::add_leaf(const std::vector<float>& points, const uint32_t* begin, const uint32_t* end) {
  const size_t first = leaf_values_.size();
  // Empty places are far from every point, yet their squared distances stay finite.
  leaf_values_.resize(first + size_t(dimensions_) * leaf_size, 1e17f);
  for (int slot = 0; slot < leaf_size; slot++) {
    const bool real = slot < end - begin;
    leaf_indices_.push_back(real ? begin[slot] : nothing);
    for (int k = 0; real && k < dimensions_; k++)
      leaf_values_[first + size_t(k) * leaf_size + slot] = points[size_t(begin[slot]) * dimensions_ + k];
  }
}

void NearestPoints::scan(uint32_t leaf, Search& search) const {
  std::array<float, leaf_size> squared;
  const float* values = &leaf_values_[size_t(leaf) * dimensions_ * leaf_size];
  if (!leaf_distances(values, search.query, dimensions_, search.best.squared, squared.data())) return;
  const uint32_t* indices = &leaf_indices_[size_t(leaf) * leaf_size];
  for (int i = 0; i < leaf_size; i++) {
    const bool better =
        squared[i] < search.best.squared || (squared[i] == search.best.squared && indices[i] < search.best.index);
    if (better && indices[i] != nothing && !(search.left_out && search.left_out(indices[i])))
      search.best = {indices[i], squared[i]};
  }
}

void NearestPoints::visit(uint32_t node, float beyond, Search& search) const {
  const Node& n = nodes_[node];
  if (n.axis < 0) return scan(n.child, search);
  const float q = search.query[n.axis];
  const bool lower_first = q - n.low < n.high - q;
  visit(lower_first ? node + 1 : n.child, beyond, search);
  const float offset = lower_first ? n.high - q : q - n.low;
  float& before = search.offsets[n.axis];
  const float farther = offset > before ? beyond - before * before + offset * offset : beyond;
  if (farther * search.tightness > search.best.squared) return;
  const float kept = before;
  before = std::max(before, offset);
  visit(lower_first ? n.child : node + 1, farther, search);
  search.offsets[n.axis] = kept;
}

NearestPoints::Match NearestPoints::find(const float* query, double slack,
                                         const std::function<bool(uint32_t)>& left_out) const {
  const float tightness = float((1 + slack) * (1 + slack));
  Search search{query, std::vector<float>(dimensions_), tightness, left_out};
  visit(0, 0, search);
  return search.best;
}

}  // namespace terrazzo
