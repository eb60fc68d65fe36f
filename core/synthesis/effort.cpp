#include "core/base/tuning.h"
#include "core/synthesis/steps.h"
#include "core/synthesis/steps/correction_pass.h"

namespace terrazzo {

namespace {

struct EffortTuning {
  int small_passes = 4;
};
const Tunable<EffortTuning> effort_tuning(
    "effort",
    {
        {&EffortTuning::small_passes, "small_passes", "passes",
         "on level 1 of exemplars under 128 pixels. Higher: fewer crumbs; costs time", "small_exemplars", 0, 100},
    });

}  // namespace

Effort effort_of(const LevelFacts& f) {
  if (f.quality == Quality::draft) {
    if (f.level <= 1) return {f.kept ? 3 : f.level + 1, 0, &sparse_window()};
    return {5, f.level >= 3 ? 6 : 2, &full_window()};
  }
  // Whole elements are squeezed to fit, and bands are laid anew: more passes would pull them apart again.
  if (f.kept && f.level <= 1 && !f.lays_elements() && !f.bands) return {6, 4, &full_window()};
  if (f.quality == Quality::best) {
    if (f.level <= 1) return {f.level == 0 ? 4 : 6, f.level == 0 ? 0 : 4, &full_window()};
    return {16, f.level >= 3 ? 24 : 8, &full_window()};
  }
  if (f.level == 0) return {f.coarsest() ? 2 : 1, 0, &sparse_window()};  // a tiny exemplar has no other level
  if (f.level == 1) return {f.small() ? effort_tuning->small_passes : 2, 0, &full_window()};
  if (f.kept) return {10, f.level >= 3 ? 24 : 8, &full_window()};
  return {7, f.level >= 3 ? 6 : 2, &full_window()};
}

int reach_of(int passes) {
  return passes * sub_passes * correction_reach;
}

}  // namespace terrazzo
