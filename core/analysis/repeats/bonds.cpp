#include "core/analysis/repeats/bonds.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <tbb/parallel_for.h>

#include "core/analysis/repeats/cell_search.h"
#include "core/analysis/repeats/lag_correlation.h"
#include "core/base/tuning.h"

namespace terrazzo {

namespace {

struct BondsTuning {
  double averaged = 0.6;
  double least_distinct = 0.15;
  double fewest_cells = 6;
};
const Tunable<BondsTuning> bonds_tuning(
    "bonds",
    {
        {&BondsTuning::averaged, "averaged", "share of a band",
         "over whose breadth differences are averaged. Higher: grain cancels; lower: joints of the next band have no "
         "say",
         "not measured: most of a band, but little of the next", 0, 10},
        {&BondsTuning::least_distinct, "least_distinct", "distinctness",
         "higher: fewer bonds are found; lower: bricks of all widths get a bond that they do not have", "bonds"},
        {&BondsTuning::fewest_cells, "fewest_cells", "cells of the exemplar",
         "higher: less chance; lower: long bricks get their bond", "not measured: fewer cells are alike by chance"},
    });

/// How much lines across the bands differ from the next, all channels together, as one channel. Grain differs at random
/// and cancels out.
Planes joints_across(const Planes& in, const Lattice& bands) {
  const bool courses = bands.first.y() != 0;
  const int reach = int(bonds_tuning->averaged / 2 * (courses ? bands.first.y() : bands.first.x()));
  Planes out = Planes::zeros(in.size, 1, in.wraps);
  tbb::parallel_for(0, in.size.height, [&](int y) {
    std::vector<float> sum(size_t(in.channels));
    for (int x = 0; x < in.size.width; x++) {
      std::fill(sum.begin(), sum.end(), 0.0f);
      for (int k = -reach; k <= reach; k++) {
        const int u = courses ? 0 : k, v = courses ? k : 0, i = courses ? 1 : 0, j = courses ? 0 : 1;
        const float* before = in.at(in.column(x + u - i), in.row(y + v - j));
        const float* after = in.at(in.column(x + u + i), in.row(y + v + j));
        for (int c = 0; c < in.channels; c++) sum[size_t(c)] += after[c] - before[c];
      }
      float squares = 0;
      for (const float v : sum) squares += v * v;
      *out.at(x, y) = std::sqrt(squares);
    }
  });
  return out;
}

}  // namespace

Lattice bond_of(const Planes& planes, const Lattice& bands, const Task& task) {
  const Cell cell = best_cell(correlate(joints_across(planes, bands), {}, task), {});
  if (cell.lattice.rank != 2 || cell.distinct < bonds_tuning->least_distinct) return bands;
  const double breadth = bands.first.sum();
  Lattice out = cell.lattice;
  for (Vector2d* v : {&out.first, &out.second}) {
    double& across = bands.first.y() != 0 ? v->y() : v->x();
    across = std::floor(across / breadth + 0.5) * breadth;
  }
  return out.cell_area() * bonds_tuning->fewest_cells <= double(planes.size.area()) && out.is_valid() ? out : bands;
}

}  // namespace terrazzo
