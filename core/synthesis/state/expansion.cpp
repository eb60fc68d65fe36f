#include "core/synthesis/state/expansion.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include <tbb/parallel_for.h>

#include "core/base/tuning.h"

namespace terrazzo {

namespace {

struct ExpansionTuning {
  double edge = appearance_limit / 5.0;
  double seen_on_edges = 0.1;
};
const Tunable<ExpansionTuning> expansion_tuning(
    "expansion",
    {
        {&ExpansionTuning::edge, "edge", "appearance units",
         "how much a joint differs from what lies beside it: about a deviation of the first component. Lower: weaker "
         "edges hide seams too, within bricks; higher: only strong joints attract seams",
         "seams", 0.001},
        {&ExpansionTuning::seen_on_edges, "seen_on_edges", "share of a mismatch",
         "higher: seams along joints must fit as well; lower: seams keep to joints, but in grids of alike tiles they "
         "run anywhere along them",
         "seams", 0, 1},
    });

float distance(const AppearanceVector* a, const AppearanceVector* b) {
  return std::sqrt(float(squared_distance(*a, *b)));
}

}  // namespace

ExpansionProblem::ExpansionProblem(Field& f, const CorrectionLevel& l, bool edges_hide)
    : field(f),
      level(l),
      plane(l.window.field()),
      along_edges(edges_hide),
      node(f.pixels.size(), untouched),
      edge_(float(expansion_tuning->edge)),
      seen_on_edges_(float(expansion_tuning->seen_on_edges)) {
  if (along_edges) find_edges();
}

void ExpansionProblem::find_edges() {
  const PaddedLevel& e = level.exemplar;
  const AppearanceVector* first = e.at(-1, -1);
  for (std::vector<float>& edges : edges_) edges.resize(size_t(e.at(e.size().width, e.size().height) - first) + 1);
  tbb::parallel_for(-1, e.size().height + 1, [&](int y) {
    for (int x = -1; x <= e.size().width; x++) {
      const AppearanceVector* v = e.at(x, y);
      edges_[0][size_t(v - first)] = distance(v, v + 1);
      edges_[1][size_t(v - first)] = distance(v, v + e.stride());
    }
  });
}

bool ExpansionProblem::continues(ExemplarPixel a, ExemplarPixel b, int side) const {
  int u = a.x + sides[side][0] * level.block, v = a.y + sides[side][1] * level.block;
  if (level.block == 1 || level.exemplar.wraps()) level.exemplar.settle_inside(u, v);
  return u == b.x && v == b.y;
}

int64_t ExpansionProblem::mismatch(ExemplarPixel a, ExemplarPixel b, int side) const {
  if (continues(a, b, side)) return 0;
  const PaddedLevel& e = level.exemplar;
  const int dx = sides[side][0], dy = sides[side][1];
  const ptrdiff_t step = dy * e.stride() + dx;
  float sum = 0;
  for (int k = 0; k < level.block; k++) {
    const AppearanceVector* here = on_side(a, dx, dy, k);
    const AppearanceVector* there = on_side(b, -dx, -dy, k);
    // Distances, not their squares: only for a metric is a minimum cut the best expansion.
    float visible = distance(here, there - step) + distance(here + step, there);
    if (along_edges) {
      const float hiding = 1 + (edge_at(here, step) + edge_at(there - step, step)) / edge_;
      visible *= seen_on_edges_ + (1 - seen_on_edges_) / (hiding * std::sqrt(hiding));
    }
    sum += visible;
  }
  return int64_t(sum * float(mismatch_unit));
}

float ExpansionProblem::edge_at(const AppearanceVector* v, ptrdiff_t step) const {
  const bool along_row = std::abs(step) == 1;
  return edges_[along_row ? 0 : 1][size_t((step < 0 ? v + step : v) - level.exemplar.at(-1, -1))];
}

const AppearanceVector* ExpansionProblem::on_side(ExemplarPixel p, int dx, int dy, int k) const {
  int u = p.x + (dx == 0 ? k : dx > 0 ? level.block - 1 : 0), v = p.y + (dy == 0 ? k : dy > 0 ? level.block - 1 : 0);
  if (level.block > 1) level.exemplar.settle_inside(u, v);
  return level.exemplar.at(u, v);
}

void Expansion::keep(int pixel) {
  problem_.node[size_t(pixel)] = ExpansionProblem::kept;
  kept_.push_back(pixel);
}

bool Expansion::offer(int pixel, ExemplarPixel shown, int32_t unary_cost) {
  const ExemplarPixel now = problem_.field.pixels[size_t(pixel)];
  if (problem_.node[size_t(pixel)] != ExpansionProblem::untouched || now == shown ||
      !problem_.level.may_change(pixel, now, shown))
    return false;
  problem_.node[size_t(pixel)] = int(free_.size());
  free_.push_back({pixel, shown, unary_cost});
  return true;
}

void Expansion::apply() {
  cut_.reset(int(free_.size()));
  for (size_t n = 0; n < free_.size(); n++) connect(int(n));
  cut_.solve();
  for (size_t n = 0; n < free_.size(); n++) {
    if (cut_.on_source_side(int(n))) {
      problem_.field.pixels[free_[n].pixel] = free_[n].offered;
      if (!problem_.unary_cost.empty()) problem_.unary_cost[free_[n].pixel] = free_[n].unary_cost;
    }
    problem_.node[free_[n].pixel] = ExpansionProblem::untouched;
  }
  for (const int i : kept_) problem_.node[size_t(i)] = ExpansionProblem::untouched;
  free_.clear();
  kept_.clear();
}

void Expansion::connect(int n) {
  const Free& f = free_[size_t(n)];
  const ExemplarPixel kept = problem_.field.pixels[f.pixel];
  if (!problem_.unary_cost.empty()) cut_.prefer_source(n, problem_.unary_cost[f.pixel] - f.unary_cost);
  for (int side = 0; side < 4; side++) {
    const int64_t m = problem_.plane.beside(f.pixel, side);
    if (m < 0) continue;
    const ExemplarPixel other = problem_.field.pixels[size_t(m)];
    const int node = problem_.node[size_t(m)];
    if (node < 0) {
      cut_.prefer_source(n, problem_.mismatch(kept, other, side) - problem_.mismatch(f.offered, other, side));
    } else if (side < 2) {  // both are free: each pair once
      const ExemplarPixel offered = free_[size_t(node)].offered;
      const int64_t neither = problem_.mismatch(kept, other, side), first = problem_.mismatch(f.offered, other, side),
                    both = problem_.mismatch(f.offered, offered, side);
      // Where both go on, either seam compares the same pixels.
      const auto [dx, dy] = sides[side];
      const bool go_on =
          problem_.level.is_next(kept, other, dx, dy) && problem_.level.is_next(f.offered, offered, dx, dy);
      const int64_t second = go_on ? first : problem_.mismatch(kept, offered, side);
      cut_.prefer_source(n, neither - first);
      cut_.prefer_source(node, first - both);
      cut_.join(n, side, node, 0);
      cut_.join(node, side + 2, n, std::max<int64_t>(0, first + second - neither - both));
    }
  }
}

}  // namespace terrazzo
