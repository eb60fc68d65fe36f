#include "core/synthesis/steps/correction.h"

#include <atomic>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include "core/base/error.h"
#include "core/base/geometry.h"
#include "core/base/tuning.h"
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
// Rows of a sub-pass that wait for the next ones: enough for all threads, few beside those of a large surface.
constexpr int band_rows = 256;
static_assert(2 * band_rows > correction_reach);

/// Pixels of a sub-pass that are worked out but not yet in the field.
class Corrected {
 public:
  explicit Corrected(const SubPass& part = {}) : part_(part), pixels_(size_t(part.columns) * size_t(part.rows)) {}

  void work_out(const CorrectionInputs& inputs, const Task& task) {
    const int tiles_down = (part_.rows + tile_rows - 1) / tile_rows;
    const int tiles = (part_.columns + tile_columns - 1) / tile_columns * tiles_down;
    std::atomic<int> done{0};
    tbb::parallel_for(0, tiles, [&](int i) {
      task.check();
      if (const int before = done++; before % tiles_told == 0) task.progress(double(before) / tiles);
      const Rect tile{i / tiles_down * tile_columns, i % tiles_down * tile_rows, tile_columns, tile_rows};
      correct_tile(inputs, part_, intersect(tile, {0, 0, part_.columns, part_.rows}), pixels_.data());
    });
  }

  void apply(Field& field) const {
    tbb::parallel_for(0, part_.rows, [&](int row) {
      for (int i = 0; i < part_.columns; i++)
        field.at(part_.x(i), part_.y(row)) = pixels_[size_t(row) * size_t(part_.columns) + size_t(i)];
    });
  }

 private:
  SubPass part_;
  std::vector<ExemplarPixel> pixels_;
};

void require_room(const CorrectionPass& pass) {
  if (pass.window->size() > size_t(most_window_pixels) || pass.random_candidates > most_random_candidates)
    throw Error(
        fmt::format("a correction pass takes windows of at most {} pixels and {} random candidates, found {} and {}",
                    most_window_pixels, most_random_candidates, pass.window->size(), pass.random_candidates));
}

}  // namespace

void correct(Field& field, const CorrectionLevel& level, const CorrectionPass& pass, UsagePenalty& usage,
             const Task& task) {
  require_room(pass);
  const CorrectionInputs inputs{field, level, pass, usage, uint32_t(correction_tuning->repeat_penalty * unit_factor)};
  for (int sub = 0; sub < sub_passes; sub++) {
    usage.recount(field, level.fixed);
    // What the following sub-passes read has to be right as well.
    const Rect wanted = intersect(whole(field.size), grown(pass.wanted, correction_reach * (sub_passes - 1 - sub)));
    const SubPass part(level.window, wanted, (sub ^ pass.pass) & 1, sub >> 1);
    if (part.columns <= 0 || part.rows <= 0) continue;
    // Pixels change once no other reads them: a band when the next one is done, the first one, which the last reads
    // where the field wraps, in the end.
    Corrected first, before;
    for (int top = 0; top < part.rows; top += band_rows) {
      SubPass band = part;
      band.first_y = part.y(top);
      band.rows = std::min(band_rows, part.rows - top);
      Corrected now(band);
      now.work_out(inputs, task.part([&](double done) {
        task.progress((sub + (top + done * band.rows) / part.rows) / sub_passes);
      }));
      before.apply(field);
      (top == 0 ? first : before) = std::move(now);
    }
    before.apply(field);
    first.apply(field);
  }
}

}  // namespace terrazzo
