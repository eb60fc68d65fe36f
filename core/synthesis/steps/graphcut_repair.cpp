#include "core/synthesis/steps/graphcut_repair.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include "core/base/tuning.h"
#include "core/synthesis/state/patches.h"
#include "core/synthesis/state/usage_penalty.h"

namespace terrazzo {

namespace {

struct GraphcutRepairTuning {
  int worse = 1;
  int worse_where_fine = 3;
  int fine_level = 1;
};
const Tunable<GraphcutRepairTuning> graphcut_repair_tuning(
    "graphcut_repair",
    {
        {&GraphcutRepairTuning::worse, "worse", "average mismatches",
         "how visible seams must be. Higher: fewer windows are repaired, which saves time; lower: more seams close",
         "not measured: the average divides windows by whether repairing is worth the time", 0, 1000},
        {&GraphcutRepairTuning::worse_where_fine, "worse_where_fine", "average mismatches",
         "the same at fine levels, which have many windows", "not measured: bounds the time of fine levels", 0, 1000},
        {&GraphcutRepairTuning::fine_level, "fine_level", "level",
         "the coarsest level that counts as fine. Higher: less time; lower: more seams close at fine levels",
         "not measured: bounds the time of fine levels"},
    });

/// The mismatch of every pixel with its right and its lower neighbour.
std::vector<int32_t> mismatches(const ExpansionProblem& problem) {
  const Size size = problem.field.size;
  const PlaneWindow& window = problem.level.window;
  std::vector<int32_t> out(problem.field.pixels.size(), 0);
  tbb::parallel_for(0, size.height, [&](int y) {
    for (int x = 0; x < size.width; x++) {
      const int i = y * size.width + x;
      for (int side = 0; side < 2; side++) {
        const int64_t n = pixel_beside(size, i, side, window.closed_x, window.closed_y);
        if (n >= 0) out[i] += int32_t(problem.mismatch(problem.field.pixels[i], problem.field.pixels[size_t(n)], side));
      }
    }
  });
  return out;
}

/// The middles of windows whose seams mismatch more than the average, the worst first.
std::vector<int> worst_windows(const ExpansionProblem& problem) {
  const Size size = problem.field.size;
  const std::vector<int32_t> values = mismatches(problem);
  int64_t total = 0;
  for (const int32_t v : values) total += v;
  const int64_t average = total * (2 * Patches::core + 1) * (2 * Patches::core + 1) / size.area();
  return worst_first(
      core_sums(values, size, problem.level.window),
      average * (problem.level.level <= graphcut_repair_tuning->fine_level ? graphcut_repair_tuning->worse_where_fine
                                                                           : graphcut_repair_tuning->worse),
      size);
}

}  // namespace

void repair_seams(Field& field, const CorrectionLevel& level, UsagePenalty& usage, uint64_t seed, const Task& task) {
  usage.recount(field, level.fixed);
  ExpansionProblem problem(field, level);
  task.check();
  const std::vector<int> windows = worst_windows(problem);
  task.check();
  tbb::enumerable_thread_specific<Patches> patches([&] { return Patches(problem, usage, seed); });
  for_each_window(windows, field, level.window, task, [&](int x, int y) {
    if (const std::optional<uint32_t> place = patches.local().best(x, y)) patches.local().lay(x, y, *place);
  });
}

}  // namespace terrazzo
