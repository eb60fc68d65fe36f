#include "core/synthesis/steps/correction.h"

#include <atomic>

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include "core/base/error.h"
#include "core/base/geometry.h"
#include "core/base/tuning.h"
#include "core/synthesis/state/sub_pass.h"
#include "core/synthesis/steps/correction_kernel.h"

namespace terrazzo {

namespace {

struct CorrectionTuning {
  double repeat_penalty = 0.25;
};
const Tunable<CorrectionTuning> correction_tuning(
    "correction", {{&CorrectionTuning::repeat_penalty, "repeat_penalty", "factor per repeat",
                    "higher: stones and leaves are not filled by one small patch over and over; lower: exemplars with "
                    "fine, regular texture keep it",
                    "correction", 0, 1000}});

// What one task corrects of a sub-pass: few enough pixels that the coarsest levels still make several tasks. It changes
// the time only, not the result.
constexpr int tile_columns = 32;
constexpr int tile_rows = 4;
constexpr int tiles_told = 512;  // that progress is told after: some milliseconds

void require_room(const CorrectionPass& pass) {
  if (pass.window->size() > size_t(most_window_pixels) || pass.random_candidates > most_random_candidates)
    throw Error(
        fmt::format("a correction pass takes windows of at most {} pixels and {} random candidates, found {} and {}",
                    most_window_pixels, most_random_candidates, pass.window->size(), pass.random_candidates));
}

}  // namespace

void correct(Field& field, const CorrectionLevel& level, const CorrectionPass& pass, UsagePenalty& usage,
             const Task& task, const std::function<void(double)>& progress) {
  require_room(pass);
  const CorrectionInputs inputs{field, level, pass, usage, uint32_t(correction_tuning->repeat_penalty * unit_factor)};
  std::vector<ExemplarPixel> next;
  for (int sub = 0; sub < sub_passes; sub++) {
    usage.recount(field, level.fixed);
    // What the following sub-passes read has to be right as well.
    const Rect wanted = intersect(whole(field.size), grown(pass.wanted, correction_reach * (sub_passes - 1 - sub)));
    const SubPass part(level.window, wanted, (sub ^ pass.pass) & 1, sub >> 1);
    if (part.columns <= 0 || part.rows <= 0) continue;
    next.resize(size_t(part.columns) * part.rows);
    const int tiles_down = (part.rows + tile_rows - 1) / tile_rows;
    const int tiles_across = (part.columns + tile_columns - 1) / tile_columns;
    const int tiles = tiles_across * tiles_down;
    std::atomic<int> done{0};
    tbb::parallel_for(0, tiles, [&](int i) {
      task.check();
      if (const int before = done++; progress && before % tiles_told == 0)
        progress((sub + double(before) / tiles) / sub_passes);
      const Rect tile{i / tiles_down * tile_columns, i % tiles_down * tile_rows, tile_columns, tile_rows};
      correct_tile(inputs, part, intersect(tile, {0, 0, part.columns, part.rows}), next.data());
    });
    tbb::parallel_for(0, part.rows, [&](int row) {
      for (int i = 0; i < part.columns; i++) field.at(part.x(i), part.y(row)) = next[size_t(row) * part.columns + i];
    });
  }
}

}  // namespace terrazzo
