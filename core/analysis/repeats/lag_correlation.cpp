#include "core/analysis/repeats/lag_correlation.h"

#include "core/base/tuning.h"
#include "core/image/float_planes.h"
#include "core/metrics/autocorrelation.h"

namespace terrazzo {

namespace {

struct LagCorrelationTuning {
  double shortest_repeat = 4;
  double least_overlap = 0.16;
  double grain = 0.8;
  double coarse = 10;
};
const Tunable<LagCorrelationTuning> lag_correlation_tuning(
    "lag_correlation",
    {
        {&LagCorrelationTuning::shortest_repeat, "shortest_repeat", "pixels",
         "higher: fine weaves are taken for grain; lower: grain is taken for a weave",
         "not measured: what repeats after fewer is grain", 2},
        {&LagCorrelationTuning::least_overlap, "least_overlap", "share of the exemplar",
         "what of it must lie on itself at a lag. Higher: lags are surer; lower: long repeats are found",
         "What each rule decides", 0, 1},
        {&LagCorrelationTuning::grain, "grain", "pixels",
         "deviation of a light blur. Higher: noise drowns less of what repeats; lower: thin joints stay",
         "What each rule decides", 0, 64},
        {&LagCorrelationTuning::coarse, "coarse", "parts of the shorter side",
         "the deviation of what does not count as a detail. Higher: large cells are taken away, too; lower: gradients "
         "drown the repeats",
         "What each rule decides", 1},
    });

/// Details only: what varies slowly would drown the repeats.
Planes without_gradients(const Planes& in, const Task& task) {
  Planes out = blurred(in, lag_correlation_tuning->grain, Beyond::mirrored, task);
  const double coarseness = std::min(in.size.width, in.size.height) / lag_correlation_tuning->coarse;
  const Planes coarse = blurred(out, coarseness, Beyond::mirrored, task);
  for (size_t i = 0; i < out.values.size(); i++) out.values[i] -= coarse.values[i];
  return out;
}

/// Of an exemplar that tiles: each lag's pairs within the exemplar and those across its borders.
std::vector<double> around_borders(const Correlogram& r, Size size) {
  const auto sum = [&](int dx, int dy) {
    if (dx < 0) {
      dx = -dx;
      dy = -dy;
    }
    const double pairs = double(size.width - dx) * (size.height - std::abs(dy));
    return pairs <= 0 ? 0.0 : r.at(dx, dy) * pairs / double(size.area());
  };
  std::vector<double> out;
  for (int dy = 1 - size.height; dy < size.height; dy++)
    for (int dx = 0; dx < size.width; dx++) {
      const int other_y = dy > 0 ? dy - size.height : dy + size.height;
      out.push_back(sum(dx, dy) + sum(dx - size.width, dy) + sum(dx, other_y) + sum(dx - size.width, other_y));
    }
  return out;
}

}  // namespace

double shortest_repeat() {
  return lag_correlation_tuning->shortest_repeat;
}

Correlation::Correlation(std::vector<double> values, Size lags, Size exemplar, bool wraps)
    : values_(std::move(values)),
      lags_(lags),
      exemplar_(exemplar),
      wraps_(wraps),
      least_overlap_(lag_correlation_tuning->least_overlap * double(exemplar.area())) {}

Correlation correlate(const Planes& planes, const std::vector<float>& counts, const Task& task) {
  Planes details = without_gradients(planes, task);
  if (!counts.empty())
    for (size_t i = 0; i < details.values.size(); i++) details.values[i] *= counts[i / planes.channels];
  const Size size = planes.size;
  const Size within = planes.wraps ? size : Size{size.width * 5 / 6, size.height * 5 / 6};
  Correlogram r = pooled_correlogram(details, within, task);
  return {planes.wraps ? around_borders(r, size) : std::move(r.values), within, size, planes.wraps};
}

Correlation pooled(const std::vector<Correlation>& all) {
  if (all.size() == 1) return all.front();
  Size lags, exemplar;
  for (const Correlation& r : all) {
    lags = {std::max(lags.width, r.lags().width), std::max(lags.height, r.lags().height)};
    exemplar = {std::max(exemplar.width, r.exemplar().width), std::max(exemplar.height, r.exemplar().height)};
  }
  std::vector<double> values;
  values.reserve(size_t(lags.width) * size_t(2 * lags.height - 1));
  for (int dy = 1 - lags.height; dy < lags.height; dy++)
    for (int dx = 0; dx < lags.width; dx++) {
      double sum = 0, pairs = 0;
      for (const Correlation& r : all) {
        if (dx >= r.lags().width || std::abs(dy) >= r.lags().height) continue;
        const double own = double(r.exemplar().width - dx) * (r.exemplar().height - std::abs(dy));
        sum += own * r.at(dx, dy);
        pairs += own;
      }
      values.push_back(pairs > 0 ? sum / pairs : 0);
    }
  return {std::move(values), lags, exemplar, false};
}

namespace {

/// Calls visit(pixel, squares, cosine, sine) with the squared edge strength over all channels, lightly blurred, and
/// with the same times the cosine and the sine of twice the edge's angle.
template <typename Visit>
void for_gradients(const Planes& in, const Task& task, Visit visit) {
  const Planes values = blurred(in, lag_correlation_tuning->grain, Beyond::mirrored, task);
  for (int y = 0; y < in.size.height; y++) {
    task.check();
    for (int x = 0; x < in.size.width; x++) {
      const float *left = values.at(in.column(x - 1), y), *right = values.at(in.column(x + 1), y);
      const float *up = values.at(x, in.row(y - 1)), *down = values.at(x, in.row(y + 1));
      float squares = 0, cosine = 0, sine = 0;
      for (int c = 0; c < in.channels; c++) {
        const float dx = right[c] - left[c], dy = down[c] - up[c];
        squares += dx * dx + dy * dy;
        cosine += dx * dx - dy * dy;
        sine += 2 * dx * dy;
      }
      visit(size_t(y) * size_t(in.size.width) + size_t(x), squares, cosine, sine);
    }
  }
}

}  // namespace

Planes outlines(const Planes& in, const Task& task) {
  Planes out = Planes::zeros(in.size, 1, in.wraps);
  for_gradients(in, task, [&](size_t i, float squares, float, float) { out.values[i] = std::sqrt(squares); });
  return out;
}

Planes orientations(const Planes& in, const Task& task) {
  Planes out = Planes::zeros(in.size, 2, in.wraps);
  for_gradients(in, task, [&](size_t i, float squares, float cosine, float sine) {
    if (squares == 0) return;
    const float strength = std::sqrt(squares);
    out.values[2 * i] = cosine / strength;
    out.values[2 * i + 1] = sine / strength;
  });
  return out;
}

}  // namespace terrazzo
