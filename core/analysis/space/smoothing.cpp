#include "core/analysis/space/smoothing.h"

#include <cmath>

#include <tbb/parallel_for.h>

namespace terrazzo {

namespace {

constexpr int passes = 3;

/// Weight 1 up to `reach` pixels away, `end` one further.
struct Box {
  int reach = 0;
  double end = 0;

  explicit Box(double variance) {
    reach = int(std::floor(0.5 * std::sqrt(12 * variance + 1) - 0.5));
    const double next = reach + 1.0;
    end = (2 * reach + 1) * (reach * next - 3 * variance) / (6 * (variance - next * next));
  }
  double sum() const { return 2 * reach + 1 + 2 * end; }
};

/// One pass over a line by a running sum; `at` brings any position into the line.
template <typename At>
void filter(const std::vector<double>& in, const Box& box, const At& at, std::vector<double>& out) {
  const int n = int(in.size());
  double sum = 0;
  for (int i = -box.reach; i <= box.reach; i++) sum += in[at(i)];
  for (int x = 0; x < n; x++) {
    const double after = in[at(x + box.reach + 1)];
    out[x] = (sum + box.end * (in[at(x - box.reach - 1)] + after)) / box.sum();
    sum += after - in[at(x - box.reach)];
  }
}

void smooth_line(float* values, int count, size_t stride, const Box& box, bool wraps) {
  std::vector<double> line(count), next(count);
  for (int i = 0; i < count; i++) line[i] = values[i * stride];
  for (int p = 0; p < passes; p++) {
    if (wraps)
      filter(
          line, box, [count](int i) { return wrap(i, count); }, next);
    else
      filter(
          line, box, [count](int i) { return std::clamp(i, 0, count - 1); }, next);
    line.swap(next);
  }
  for (int i = 0; i < count; i++) values[i * stride] = float(line[i]);
}

}  // namespace

ExemplarPlanes box_smoothed(const ExemplarPlanes& planes, double deviation, const Task& task) {
  ExemplarPlanes out = planes;
  if (!(deviation > 0)) return out;
  const Box box(deviation * deviation / passes);
  const int n = out.channels, width = out.size.width, height = out.size.height;
  tbb::parallel_for(0, height, [&](int y) {
    task.check();
    for (int c = 0; c < n; c++) smooth_line(out.at(0, y) + c, width, size_t(n), box, out.wraps);
  });
  tbb::parallel_for(0, width, [&](int x) {
    task.check();
    for (int c = 0; c < n; c++) smooth_line(out.at(x, 0) + c, height, size_t(n) * width, box, out.wraps);
  });
  return out;
}

}  // namespace terrazzo
