#include "tests/energy/energy.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <tbb/parallel_for.h>

#include "core/synthesis/state/expansion.h"
#include "tests/energy/window_coherence.h"

namespace terrazzo {

namespace {

constexpr int32_t usual = WindowCoherence::usual;

/// What a field costs at single pixels.
class PixelEnergy {
 public:
  PixelEnergy(Field& field, const CorrectionLevel& level)
      : field_(field), level_(level), windows_(level), problem_(field, level) {}

  void add(int x, int y, Energy& sum) const {
    sum.pixels++;
    const ExemplarPixel here = field_.at(x, y);
    if (WindowCoherence::fits(x, field_.size.width, level_.window.closed_x) &&
        WindowCoherence::fits(y, field_.size.height, level_.window.closed_y)) {
      const int32_t distance = windows_.distance(window_around(x, y));
      sum.windows += distance;
      sum.unlike += distance > usual ? 1 : 0;
    }
    for (int side = 0; side < 2; side++)
      if (const int64_t beside = problem_.plane.index(x + sides[side][0], y + sides[side][1]); beside >= 0) {
        const int64_t mismatch = problem_.mismatch(here, field_.pixels[size_t(beside)], side);
        sum.seams += mismatch;
        sum.cut += mismatch > 0 ? 1 : 0;
      }
    if (level_.phase.active())
      sum.phase += int64_t(256 * (level_.phase.penalty(here.x, here.y, level_.window.x(x), level_.window.y(y)) - 1));
  }

 private:
  WindowCoherence::Window window_around(int x, int y) const {
    WindowCoherence::Window out;
    size_t i = 0;
    for (int dy = -WindowCoherence::reach; dy <= WindowCoherence::reach; dy++)
      for (int dx = -WindowCoherence::reach; dx <= WindowCoherence::reach; dx++)
        out[i++] = field_.pixels[size_t(problem_.plane.index(x + dx, y + dy))];
    return out;
  }

  const Field& field_;
  const CorrectionLevel& level_;
  WindowCoherence windows_;
  ExpansionProblem problem_;
};

}  // namespace

Energy energy_of(Field field, const CorrectionLevel& level, int64_t sample, const Task& task) {
  // Odd, so that all pixels of the blocks from which a level begins have their turn.
  const int step = std::max(1, int(std::sqrt(double(field.size.area()) / double(sample)))) | 1;
  const int rows = (field.size.height + step - 1) / step;
  const PixelEnergy pixel_energy(field, level);
  std::vector<Energy> sums(static_cast<size_t>(rows));
  tbb::parallel_for(0, rows, [&](int row) {
    task.check();
    for (int x = 0; x < field.size.width; x += step) pixel_energy.add(x, row * step, sums[size_t(row)]);
  });
  Energy all;
  for (const Energy& s : sums) {
    all.pixels += s.pixels;
    all.windows += s.windows;
    all.unlike += s.unlike;
    all.seams += s.seams;
    all.cut += s.cut;
    all.phase += s.phase;
  }
  return all;
}

}  // namespace terrazzo
