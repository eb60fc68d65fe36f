#include "core/metrics/copies.h"

#include <algorithm>
#include <cmath>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "core/base/disjoint_sets.h"
#include "core/base/tuning.h"
#include "core/metrics/patches.h"
#include "core/numeric/nearest.h"

namespace terrazzo {

namespace {

struct CopiesTuning {
  double slack = 0.2;
  int eights_of_dimensions = 2;
};
const Tunable<CopiesTuning> copies_tuning(
    "copies", {
                  {&CopiesTuning::slack, "slack", "share of a distance",
                   "by which the nearest patch may be missed. Higher: less time; lower: copies among many alike "
                   "patches are found whole",
                   "not measured: taken over from the code before constants were listed"},
                  {&CopiesTuning::eights_of_dimensions, "eights_of_dimensions", "eight components",
                   "of a patch in which the nearest is looked for. Higher: alike patches are kept apart; costs time",
                   "not measured: taken over from the code before constants were listed", 1, 6},
              });

}  // namespace

CopiedRegions copied_regions(Size size, const std::vector<Shift>& shifts) {
  DisjointSets sets(shifts.size());
  for (int y = 0; y < size.height; y++)
    for (int x = 0; x < size.width; x++) {
      const uint32_t i = uint32_t(y) * uint32_t(size.width) + uint32_t(x);
      for (int step = 1; step <= 2; step++) {
        const uint32_t right = i + uint32_t(step), down = i + uint32_t(step * size.width);
        if (x + step < size.width && shifts[i] == shifts[right]) sets.join(i, right);
        if (y + step < size.height && shifts[i] == shifts[down]) sets.join(i, down);
      }
    }
  std::vector<int64_t> area(shifts.size());
  for (uint32_t i = 0; i < shifts.size(); i++) area[sets.find(i)]++;
  CopiedRegions out;
  for (const int64_t a : area) {
    out.typical_side += double(a) * std::sqrt(double(a));
    out.largest_area = std::max(out.largest_area, double(a));
  }
  out.typical_side /= double(shifts.size());
  return out;
}

double verbatim_copies(const Planes& exemplar, const Planes& output, const Task& task) {
  const int dimensions = 8 * copies_tuning->eights_of_dimensions;
  const double slack = copies_tuning->slack;
  const PatchList from_exemplar = all_patches(exemplar.size), from_output = all_patches(output.size);
  const Projection space = principal_projection(exemplar, from_exemplar, dimensions, task);
  const NearestPoints tree(project(exemplar, from_exemplar, space, task), dimensions);
  const std::vector<float> points = project(output, from_output, space, task);
  const int across = patch_positions(exemplar.size).width, width = patch_positions(output.size).width;
  std::vector<Shift> shifts(from_output.size());
  tbb::parallel_for(tbb::blocked_range<size_t>(0, shifts.size(), 512), [&](const auto& range) {
    task.check();
    for (size_t i = range.begin(); i < range.end(); i++) {
      const int found = int(tree.find(&points[i * dimensions], slack).index);
      shifts[i] = {found % across - int(i) % width, found / across - int(i) / width};
    }
  });
  const CopiedRegions copies = copied_regions(patch_positions(output.size), shifts);
  return copies.typical_side / std::sqrt(double(exemplar.size.area()));
}

}  // namespace terrazzo
